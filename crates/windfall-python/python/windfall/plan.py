"""Plans of studies: `wf.plan.mean(…)` is `wf.plan_mean(…)`."""

from windfall._commands import (
    plan_achieved as achieved,
    plan_critical_energy as critical_energy,
    plan_difference as difference,
    plan_groups as groups,
    plan_mean as mean,
    plan_model as model,
    plan_population as population,
    plan_slope as slope,
    plan_surface as surface,
)

__all__ = [
    "achieved",
    "critical_energy",
    "difference",
    "groups",
    "mean",
    "model",
    "population",
    "slope",
    "surface",
]
