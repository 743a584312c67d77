"""A bin of apples on a lattice above the floor, as scene.toml."""

PLANES = """[[walls]]
name = "{}"
material = "steel"
plane = {{ point = {}, normal = {} }}
"""


def write_scene(path, count, end):
    """Writes a scene of `count` apples that ends at `end` seconds."""
    side = max(4, round(count ** (1 / 3)))
    width, height = side * 0.084, (count // side**2 + 2) * 0.084
    planes = [
        ("floor", [0, 0, 0], [0, 0, 1]),
        ("left", [0, 0, 0], [1, 0, 0]),
        ("right", [width, 0, 0], [-1, 0, 0]),
        ("front", [0, 0, 0], [0, 1, 0]),
        ("back", [0, width, 0], [0, -1, 0]),
    ]
    contact = "friction = 0.3\nannuli = 1\npoisson = 0.3\ntangential_damping = 1.0\n"
    path.write_text(
        f"""format = 1
materials = ["apple", "steel"]
[scene]
title = "A bin of {count} apples"
gravity = "9.81 m/s^2"
time_step = "20 us"
end = "{end} s"
[[contacts]]
between = ["apple", "apple"]
law = "kuwabara-kono(k=753599, c=1524)"
effective_radius = "18.75 mm"
{contact}
[[contacts]]
between = ["apple", "steel"]
law = "kuwabara-kono(k=753599, c=1524)"
effective_radius = "37.5 mm"
{contact}
[[fruit]]
material = "apple"
count = {count}
diameter = "75 mm"
diameter_sd = "2 mm"
density = "840 kg/m^3"
lattice = {{ low = [0, 0, 0], high = [{width}, {width}, {height}], velocity = [0.05, 0.03, -0.5] }}
"""
        + "".join(PLANES.format(*plane) for plane in planes)
    )
