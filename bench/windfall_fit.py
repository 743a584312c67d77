"""k and c of each recording with windfall: python windfall_fit.py FOLDER OUT.csv [THREADS]"""

import sys
from pathlib import Path

import numpy as np
import windfall as wf

rig = wf.Pendulum(inertia="0.01435 kg m^2", arm="0.505 m", mass="80 g", centre_of_mass="0.35 m")
paths = sorted(Path(sys.argv[1]).glob("*.npz"))
recordings = [{name: data[name] for name in ("t", "x", "force")} for data in map(np.load, paths)]
fits = wf.fit_many(
    recordings,
    names=[path.stem for path in paths],
    rig=rig,
    law="kuwabara-kono",
    threads=int(sys.argv[3]) if len(sys.argv) > 3 else None,
)
rows = ["id,k,k_low,k_high,c,c_low,c_high"]
for fit in fits:
    if not fit.result.left_out:
        limits = [(p.value, p.low, p.high) for p in (fit.params.k, fit.params.c)]
        rows.append(",".join([fit.id, *map(str, limits[0] + limits[1])]))
Path(sys.argv[2]).write_text("\n".join(rows) + "\n")
