"""Faults of recordings, each at four strengths.

A fault takes a clean Record, its strength (0 … 3) and a source of chance, and returns
the Record as a laboratory would have made it. NAMES says which findings name the cause.
"""

import numpy as np
from fault_impacts import COUNT, EFFECTIVE_MASS, RATE
from scipy.signal import lfilter


def times(record):
    return np.arange(record.force.size) / RATE


def clean(record, strength, _):
    """Nothing wrong; a constant zero of the sensor is no fault."""
    record.force += (0.0, 1.0, 7.0, -30.0)[strength]
    return record


def drift(record, strength, rng):
    """The zero rises along the recording, by a part of the peak."""
    rise = (0.02, 0.1, 0.5, 2.0)[strength] * record.peak * rng.choice((-1, 1))
    record.force += rise * np.linspace(-0.5, 0.5, record.force.size)
    return record


def hum(record, strength, rng):
    """The mains: 50 Hz in the force."""
    size = (0.02, 0.05, 0.2, 0.5)[strength] * record.peak
    record.force += size * np.sin(2 * np.pi * (50 * times(record) + rng.uniform()))
    return record


def bump(record, strength, rng):
    """A knock on the bench before the contact, in the force alone."""
    size = (0.1, 0.3, 0.9, 1.5)[strength] * record.peak
    at = record.onset / RATE - rng.uniform(0.8e-3, 2e-3)
    record.force += size * np.exp(-(((times(record) - at) / 1.5e-4) ** 2))
    return record


def double_hit(record, strength, rng):
    """The fruit comes back and strikes again, in force and motion."""
    size = (0.1, 0.3, 0.6, 1.0)[strength] * record.peak
    first = record.end + int(rng.uniform(0.15, 1.0) * record.length)
    length = int(0.8 * record.length)
    pulse = np.zeros(record.force.size)
    rows = np.arange(first, min(first + length, pulse.size))
    pulse[rows] = size * np.sin(np.pi * (rows - first) / length)
    record.force += pulse
    push = np.cumsum(np.cumsum(pulse)) / RATE**2 / EFFECTIVE_MASS
    record.position -= push / COUNT
    return record


def start_in_contact(record, strength, _):
    """The recorder was triggered too late."""
    first = record.onset + int((0.02, 0.1, 0.3, 0.6)[strength] * record.length)
    record.force = record.force[first:]
    record.position = record.position[first:]
    return record


def clipped(record, strength, _):
    """The range of the recorder is too small."""
    record.force = np.minimum(record.force, (0.95, 0.8, 0.6, 0.4)[strength] * record.peak)
    return record


def glitch(record, strength, rng):
    """Single samples that no sensor could give: outside and inside of the contact."""
    inside = strength >= 2
    size = (1.0, 10.0, 0.5, 3.0)[strength] * record.peak * rng.choice((-1, 1))
    if inside:
        at = rng.integers(record.onset + record.length // 10, record.end - record.length // 10)
    else:
        at = rng.choice((rng.integers(50, record.onset - 50), rng.integers(record.end + 50, record.force.size - 50)))
    if rng.uniform() < 0.5:
        record.force[at] += size
    else:
        # A count that jumps and comes back.
        record.position[at] += (30, 300, 30, 3000)[strength]
    return record


def lost_samples(record, strength, rng):
    """Rows that the computer did not take up; half of the files say when the others were taken."""
    lost = int((0.01, 0.05, 0.2, 0.5)[strength] * record.length)
    at = rng.integers(record.onset - record.length // 2, record.end + record.length // 2)
    kept = np.ones(record.force.size, bool)
    kept[at : at + lost] = False
    record.kept = kept
    record.timed = rng.uniform() < 0.5
    return record


def late_channel(record, strength, _):
    """The force comes later than the position."""
    late = (4, 20, 60, 200)[strength]
    record.force = np.concatenate([record.force[:late][::-1], record.force[:-late]])
    return record


def correlated_noise(record, strength, rng):
    """Noise of an amplifier, whose neighbouring samples agree."""
    size, persistence = ((0.3, 0.8), (1.0, 0.8), (1.0, 0.95), (2.0, 0.98))[strength]
    pushes = size * np.sqrt(1 - persistence**2) * rng.normal(size=record.force.size + 500)
    record.force += lfilter([1], [1, -persistence], pushes)[500:]
    return record


def reversed_signs(record, strength, _):
    """A cable or the phases of the encoder the other way round."""
    if strength in (0, 2, 3):
        record.force = -record.force
    if strength in (1, 2):
        record.position = 200 - record.position
    if strength == 3:
        record.force += 5.0
    return record


def several_contacts(record, strength, rng):
    """The arm comes back and strikes again; the first contact is meant."""
    parts = [record]
    for scale in ((0.3,), (1.0,), (1.5,), (0.6, 0.3))[strength]:
        again = record.copy()
        noise = again.force.copy()
        noise[again.onset : again.end] = 0
        again.force = scale * (again.force - noise) + np.roll(noise, rng.integers(200, 900))
        middle = again.position[again.onset]
        again.position = middle + scale * (again.position - middle)
        parts.append(again)
    force, position = parts[0].force, parts[0].position
    for part in parts[1:]:
        joined, quiet = joint(position, part.position)
        force = np.concatenate([force, np.resize(record.force[: record.onset - 200], quiet), part.force])
        position = np.concatenate([position, joined, part.position])
    record.force, record.position = force, position
    return record


def joint(before, after):
    """Counts on the way back from the end of one part to the begin of the next."""
    count = int(0.06 * RATE)
    slope = 400
    start, end = before[-1], after[0]
    leave = (before[-1] - before[-slope]) / slope * count
    come = (after[slope] - after[0]) / slope * count
    s = np.arange(1, count + 1) / (count + 1)
    curve = (
        (2 * s**3 - 3 * s**2 + 1) * start + (s**3 - 2 * s**2 + s) * leave
        + (3 * s**2 - 2 * s**3) * end + (s**3 - s**2) * come
    )  # fmt: skip
    return curve, count


def wrong_units(record, strength, _):
    """campaign.toml says pounds, kilograms or another encoder."""
    if strength == 0:
        record.told_force = 4.4482216
    elif strength == 1:
        record.told_force = 1 / 9.80665
    elif strength == 2:
        record.told_counts = 4.0
    else:
        record.told_force = 1000.0
    return record


FAULTS = {
    "clean": clean,
    "drift": drift,
    "hum": hum,
    "bump": bump,
    "double hit": double_hit,
    "start in contact": start_in_contact,
    "clipped": clipped,
    "glitch": glitch,
    "lost samples": lost_samples,
    "late channel": late_channel,
    "correlated noise": correlated_noise,
    "reversed signs": reversed_signs,
    "several contacts": several_contacts,
    "wrong units": wrong_units,
}

# Findings that name the cause of each.
NAMES = {
    "clean": set(),
    "drift": {"drift-removed", "zero-shift"},
    "hum": {"hum-removed", "drift-removed"},
    "bump": {"bump", "several-contacts", "drifting-zero"},
    "double hit": {"several-contacts"},
    "start in contact": {"contact-at-start"},
    "clipped": {"clipped"},
    "glitch": {"glitch", "glitch-in-contact", "spike"},
    "lost samples": {"irregular-sampling", "gap-in-contact", "motion-mismatch", "impulse-mismatch", "late-channel", "glitch", "missing-samples", "energy-mismatch"},
    "late channel": {"late-channel", "energy-mismatch"},
    "correlated noise": {"threshold-in-noise", "threshold-raised"},
    "reversed signs": {"reversed"},
    "several contacts": {"several-contacts"},
    "wrong units": {"energy-mismatch", "impulse-mismatch"},
}
