"""Designs of experiments: `wf.design.ccd(…)` is `wf.design_ccd(…)`."""

from windfall._commands import (
    design_box_behnken as box_behnken,
    design_ccd as ccd,
    design_d_optimal as d_optimal,
    design_factorial as factorial,
    design_i_optimal as i_optimal,
    design_latin_hypercube as latin_hypercube,
    design_plackett_burman as plackett_burman,
    design_sobol as sobol,
    design_split_plot as split_plot,
)

__all__ = [
    "box_behnken",
    "ccd",
    "d_optimal",
    "factorial",
    "i_optimal",
    "latin_hypercube",
    "plackett_burman",
    "sobol",
    "split_plot",
]
