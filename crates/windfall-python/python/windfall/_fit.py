"""Fits of arrays."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from windfall import _native
from windfall._call import Value, Words
from windfall._errors import WindfallError
from windfall._progress import Tell, bar
from windfall._result import Result, table_html
from windfall._samples import CHANNELS, columns_of, si_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Quantity = Union[str, float, Any]
"""Text with a unit, a number in SI, or a quantity of pint."""


@dataclass(frozen=True)
class Pendulum:
    """An arm that strikes the fruit.

    * `inertia`: moment of inertia about the pivot; kg m²
    * `arm`: pivot to point of contact; m
    * `mass`: of arm and impactor; kg
    * `centre_of_mass`: pivot to centre of mass; m
    * `gravity`: acceleration of gravity; m/s², 9.80665 if left out
    """

    inertia: Quantity
    arm: Quantity
    mass: Quantity
    centre_of_mass: Quantity
    gravity: Quantity | None = None


@dataclass(frozen=True)
class Carriage:
    """A body on a line: a cart on an incline, a drop hammer.

    * `mass`: of the body; kg, or "from impulse"
    * `driving_acceleration`: towards the fruit when nothing touches; m/s², 0 if left out
    """

    mass: Quantity
    driving_acceleration: Quantity | None = None


Rig = Union[Pendulum, Carriage]

_UNITS = {
    "inertia": ("kg m^2", "[mass] * [length] ** 2"),
    "arm": ("m", "[length]"),
    "mass": ("kg", "[mass]"),
    "centre_of_mass": ("m", "[length]"),
    "gravity": ("m/s^2", "[length] / [time] ** 2"),
    "driving_acceleration": ("m/s^2", "[length] / [time] ** 2"),
}


class Fit:
    """A law, fitted to one impact. What it says is read when it is first asked for."""

    def __init__(self, native: _native.Fitted, place: int) -> None:
        self._native = native
        self._place = place

    @property
    def id(self) -> str:
        """What the recording was called."""
        return self._native.id(self._place)

    @property
    def law(self) -> str:
        """The name of the law."""
        return self._native.law(self._place)

    @cached_property
    def result(self) -> Result:
        """All that the command says of an impact."""
        return Result.from_json(self._native.impact(self._place))

    @property
    def params(self) -> Result:
        """Parameters of the law by name, each with `value`, `sd`, `low`, `high`, `unit`."""
        params: Result = self.result.parameters
        return params

    @property
    def nuisances(self) -> Result:
        """Initial velocity, onset and offset, as far as they were estimated."""
        nuisances: Result = self.result.nuisances
        return nuisances

    @property
    def derived(self) -> Result:
        """Velocities, energies, peaks."""
        derived: Result = self.result.derived
        return derived

    @property
    def findings(self) -> tuple[Result, ...]:
        """What a reader must know."""
        findings: tuple[Result, ...] = self.result["findings"]
        return findings

    @cached_property
    def detail(self) -> dict[str, Any]:
        """Samples, residuals, weights, covariance and draws, in groups for `arviz.from_dict`.

        They are found by fitting once more, when they are first asked for.
        """
        detail: dict[str, Any] = json.loads(self._native.detail(self._place))
        return detail

    def to_arviz(self) -> Any:
        """`detail` as ArviZ has it: draws (with `intervals="posterior"`), samples, residuals."""
        arviz: Any = import_module("arviz")
        return arviz.from_dict(**self.detail)

    @property
    def estimates(self) -> tuple[str, ...]:
        """Names of what was estimated, in the order of `cov`."""
        return tuple(self.detail["coords"]["parameter"])

    @property
    def cov(self) -> NDArray[np.float64]:
        """Covariance of the estimates."""
        return np.array(self.detail["constant_data"]["covariance"], dtype=np.float64)

    @property
    def residuals(self) -> dict[str, NDArray[np.float64]]:
        """Predicted − measured of each quantity in the cost function."""
        return {name: self._series(name, "residual") for name in self.detail["observed_data"]}

    def _series(self, quantity: str, what: str) -> NDArray[np.float64]:
        return np.array(self.detail["constant_data"][f"{quantity}_{what}"], dtype=np.float64)

    def plot(self, axes: Any = None) -> Any:
        """Draws samples and the fitted law with matplotlib, a panel for each quantity."""
        measured = self.detail["observed_data"]
        if axes is None:
            pyplot: Any = import_module("matplotlib.pyplot")
            _, axes = pyplot.subplots(len(measured), 1, sharex=True, squeeze=False)
        panels = np.ravel(axes)
        for panel, (name, samples) in zip(panels, measured.items()):
            time = self.detail["coords"][f"{name}_time"]
            panel.plot(time, samples, ".", markersize=3, label="measured")
            panel.plot(time, self._series(name, "predicted"), label=self.law)
            panel.set_ylabel(f"{name} / SI")
        panels[0].legend()
        panels[-1].set_xlabel("time / s")
        return axes

    def __repr__(self) -> str:
        values = ", ".join(
            f"{name}={self.params[name].value:.6g} {self.params[name].unit}"
            for name in self.params.keys()
        )
        return f"Fit({self.law}: {values})"

    def _repr_html_(self) -> str:
        rows = [{"parameter": name, **self.params[name].to_dict()} for name in self.params.keys()]
        return table_html(rows)


class Fits(Sequence[Fit]):
    """Fits of several recordings: in their order, and of each in the order of the laws.

    * `failed`: what could not be fitted, with `id`, `law` and `message`
    """

    def __init__(self, fits: Sequence[Fit], failed: Sequence[Result]) -> None:
        self._fits = tuple(fits)
        self.failed = tuple(failed)

    def __getitem__(self, place: Any) -> Any:
        return self._fits[place]

    def __len__(self) -> int:
        return len(self._fits)

    def __iter__(self) -> Iterator[Fit]:
        return iter(self._fits)

    def rows(self) -> list[dict[str, Any]]:
        """A row for each parameter of each fit, as for a data frame."""
        return [
            {"id": fit.id, "law": fit.law, "parameter": name, **fit.params[name].to_dict()}
            for fit in self
            for name in fit.params.keys()
        ]

    def to_pandas(self) -> Any:
        """`rows` as a data frame of pandas."""
        pandas: Any = import_module("pandas")
        return pandas.DataFrame(self.rows())

    def to_polars(self) -> Any:
        """`rows` as a data frame of polars."""
        polars: Any = import_module("polars")
        return polars.DataFrame(self.rows(), infer_schema_length=None)

    def _repr_html_(self) -> str:
        return table_html(self.rows())


def fit(
    t: ArrayLike,
    x: ArrayLike | None = None,
    v: ArrayLike | None = None,
    a: ArrayLike | None = None,
    force: ArrayLike | None = None,
    *,
    rig: Rig,
    law: str,
    name: str = "recording",
    **options: Value | bool | Sequence[Value] | None,
) -> Fit:
    """Fits a law to an impact in arrays, as `windfall fit FILE --rig …` does to one in a file.

    * `t`: times; s
    * `x`, `v`, `a`: position, velocity and acceleration of the impactor; m, m/s, m/s²
    * `force`: contact force; N
    * `rig`: what struck the fruit
    * `law`: such as "kuwabara-kono" or "power-law(n=1.5)"
    * `name`: what the recording is called; the draws of bootstrap and posterior depend on it
    * `options`: `intervals`, `free`, `prior`, `bounds`, `weights`, `noise`, `onset`, `end`,
      `threshold`, … as of `fit_campaign`

    Arrays are in SI, or know their unit as those of pint do. Gaps have to be left out.
    """
    arrays = {"t": t, "x": x, "v": v, "a": a, "force": force}
    found, failed = _fitted([(name, arrays)], rig, [law], options, None)
    if failed:
        raise WindfallError(failed[0].message, failed[0])
    return found[0]


def fit_many(
    recordings: Sequence[Mapping[str, Any]],
    *,
    rig: Rig,
    law: str | Sequence[str],
    names: Sequence[str] | None = None,
    threads: int | None = None,
    progress: bool = False,
    **options: Value | bool | Sequence[Value] | None,
) -> Fits:
    """Fits laws to many impacts at once; the numbers are those of `fit`.

    * `recordings`: the arrays of each: `{"t": …, "x": …, "force": …}`
    * `law`: one law, or several
    * `names`: what the recordings are called; "1", "2", … if left out
    * `threads`: all cores if left out

    A recording that cannot be used does not stop the others: it is in `failed`.
    """
    called = names if names is not None else [str(n + 1) for n in range(len(recordings))]
    if len(called) != len(recordings):
        raise ValueError(f"names: there are {len(called)}, and {len(recordings)} recordings")
    laws = [law] if isinstance(law, str) else list(law)
    options = {**options, "threads": threads}
    with bar(progress) as tell:
        return Fits(*_fitted(list(zip(called, recordings)), rig, laws, options, tell))


def _fitted(
    recordings: Sequence[tuple[str, Mapping[str, Any]]],
    rig: Rig,
    laws: Sequence[str],
    options: Mapping[str, Any],
    tell: Tell | None,
) -> tuple[list[Fit], list[Result]]:
    """Fits, and what could not be fitted."""
    if not recordings:
        return [], []
    held = [(name, columns_of(arrays)) for name, arrays in recordings]
    given = {tuple(column[0] for column in columns) for _, columns in held}
    if len(given) > 1:
        raise ValueError("recordings: expected the same arrays in all of them")
    request = _request(rig, laws, given.pop(), options)
    found = _native.fit(held, request, tell)
    fits, failed = [], []
    for (name, _), (native, wrong) in zip(recordings, found):
        if native is None:
            message, is_request = wrong or ("", False)
            if is_request:
                raise ValueError(message)
            failed.append(Result({"id": name, "law": None, "message": message, "findings": []}))
            continue
        fits += [Fit(native, place) for place in range(len(native))]
        failed += [Result.from_json(own) for own in native.failed()]
    return fits, failed


_requests: dict[Any, _native.FitRequest] = {}
"""Requests by what they were made of: to read one takes as long as to fit an impact, and the
next recording usually has the same."""
_REMEMBERED = 8
_PLAIN = {str, int, float, type(None)}
"""Types of values that are equal only where they are the same words."""


def _request(
    rig: Rig, laws: Sequence[str], given: tuple[str, ...], options: Mapping[str, Any]
) -> _native.FitRequest:
    """What is asked of recordings with the arrays `given`."""
    # Numbers that are equal can stand for different words: `True` and 1.
    key: Any = (rig, *laws, given, *options.items(), *map(type, options.values()))
    try:
        known = _requests.get(key)
    except TypeError:
        known, key = None, None
    if known is not None:
        return known
    channels = [(name, *CHANNELS[name]) for name in given if name in CHANNELS]
    words = [*_rig_words(rig), "--time=t"]
    words += [f"--channel={channel}={name}:{unit}" for name, channel, unit in channels]
    with Words() as own:
        words += own.of_option("--law", laws)
        for name, value in options.items():
            words += own.of_option(f"--{name.replace('_', '-')}", value)
        request = _native.FitRequest(words)
        # The file of a data frame is removed now. A quantity equals one in another unit, whose
        # words may differ in the last digit.
        plain = _PLAIN.issuperset(map(type, vars(rig).values()))
        if key is not None and plain and not own.files:
            if len(_requests) == _REMEMBERED:
                _requests.clear()
            _requests[key] = request
    return request


def _rig_words(rig: Rig) -> list[str]:
    if not isinstance(rig, (Pendulum, Carriage)):
        raise TypeError(f"rig: expected a Pendulum or a Carriage, found {rig!r}")
    words = [f"--rig={type(rig).__name__.lower()}"]
    for field in fields(rig):
        unit, dimension = _UNITS[field.name]
        value = si_of(field.name, getattr(rig, field.name), dimension)
        if value is not None:
            text = value if isinstance(value, str) else f"{float(value)!r} {unit}"
            words.append(f"--{field.name.replace('_', '-')}={text}")
    return words
