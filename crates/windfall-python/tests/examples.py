"""What a person writes with windfall: its types are checked, and it runs."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import windfall as wf


def fit_arrays(recording: wf.Recording) -> wf.Fit:
    """An impact in arrays, however they were recorded."""
    counts = recording["count"].values
    rig = wf.Pendulum(
        inertia="0.01435 kg m^2", arm="0.505 m", mass="0.11 kg", centre_of_mass="0.3 m"
    )
    return wf.fit(
        np.arange(len(counts)) / 200e3,
        x=0.505 * np.sin(counts * (2 * np.pi / 360_000)),
        force=recording["force_V"].values / 11e-3,
        rig=rig,
        law="kuwabara-kono",
    )


def main(folder: Path) -> None:
    """From recordings to a law, and what the law says of another impact."""
    directory = folder / "campaign"
    wf.simulate_pendulum(
        law="kuwabara-kono(k=753599, c=1524)", recordings=directory, encoder="counts"
    )
    fit = fit_arrays(wf.read(directory / "raw" / "specimen-01.csv"))
    print(fit.params["k"].value, fit.params["k"].low, fit.params["k"].high)
    print(np.sqrt(np.diag(fit.cov)), fit.residuals["force"].std())

    campaign = wf.Campaign(directory)
    result = campaign.fit()
    print(len(result.impacts), [finding.code for finding in result.findings])
    card = campaign.population().card()
    print(card.simulate(mass="0.2 kg", velocity="0.5 m/s").peak_force)

    design = wf.design_factorial(factor=["a=1,2", "b=3,4"], out=folder / "design.csv")
    print(design.keys())
    try:
        wf.summary(folder / "absent.csv", value="k")
    except ValueError as error:
        print(error)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
