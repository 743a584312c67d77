"""Writes the same bin of apples for every engine: scene_bin.py COUNT FOLDER [LAYERS].

COUNT fruit of 70 to 80 mm on a loose lattice of so many layers (as many as there are along an
edge, if left out) above the floor of an open bin, with small random displacements and
velocities: bin.txt for windfall's example bin_fill, bin.lmp and bin.deck for
LAMMPS (gran/hertz/history: Hertz's contact with Mindlin's tangential history).
"""

import math
import random
import sys

STEP, GRAVITY, DENSITY, FRICTION, POISSON = 2e-5, 9.81, 840.0, 0.3, 0.3
K, C, RADIUS, PITCH = 753599.0, 1524.0, 0.0375, 0.084

count, folder = int(sys.argv[1]), sys.argv[2]
draw = random.Random(1).uniform
floor = count / int(sys.argv[3]) if len(sys.argv) > 3 else count ** (2 / 3)
side = max(4, round(floor**0.5))
width = side * PITCH
fruit = []
for n in range(count):
    cell = (n % side, n // side % side, n // (side * side))
    place = [(own + 0.5) * PITCH + draw(-0.001, 0.001) for own in cell]
    velocity = [draw(-0.1, 0.1), draw(-0.1, 0.1), draw(-0.1, 0.1) - 0.5]
    fruit.append((place, velocity, draw(0.035, 0.04)))
top = max(own[0][2] for own in fruit) + 0.1

with open(f"{folder}/bin.txt", "w") as out:
    print(f"# width {width}", file=out)
    for n, (place, velocity, radius) in enumerate(fruit):
        print(n + 1, *place, *velocity, radius, file=out)

with open(f"{folder}/bin.lmp", "w") as out:
    print(f"apples\n\n{count} atoms\n1 atom types\n", file=out)
    print(f"0 {width} xlo xhi\n0 {width} ylo yhi\n-0.01 {top} zlo zhi\n\nAtoms # sphere\n", file=out)
    for n, (place, _, radius) in enumerate(fruit):
        print(n + 1, 1, 2 * radius, DENSITY, *place, file=out)
    print("\nVelocities\n", file=out)
    for n, (_, velocity, _) in enumerate(fruit):
        print(n + 1, *velocity, 0, 0, 0, file=out)

# F = (kn d + gamma m_eff v) sqrt(R d): kn = k/sqrt(R*), gamma = c/(sqrt(R*) m_eff), at the
# mean size; k_t d^0.5 sqrt(R*) is Mindlin's 2 (1 - nu)/(2 - nu) times the normal stiffness.
mass = DENSITY * 4 / 3 * math.pi * RADIUS**3
ratio = 1.5 * 2 * (1 - POISSON) / (2 - POISSON)


def coefficients(radius, effective_mass):
    kn, gamma = K / math.sqrt(radius), C / (math.sqrt(radius) * effective_mass)
    return f"{kn} {ratio * kn} {gamma} {gamma} {FRICTION} 1 limit_damping"


def granular(radius, effective_mass):
    """The same in the words of pair_style granular."""
    kn, kt, gamma, _, friction, *_ = coefficients(radius, effective_mass).split()
    return f"hertz {kn} {gamma} tangential mindlin {kt} 1 {friction} damping viscoelastic limit_damping"


wall = f"wall/gran hertz/history {coefficients(RADIUS, mass)}"
with open(f"{folder}/bin.deck", "w") as out:
    out.write(f"""units si
atom_style sphere
atom_modify map array sort 1000 0.08
boundary f f f
newton off
comm_modify vel yes
read_data {folder}/bin.lmp
variable granular index 0
if "${{granular}} == 0" then &
    "pair_style gran/hertz/history {coefficients(RADIUS / 2, mass / 2)}" "pair_coeff * *" &
else "pair_style granular" "pair_coeff * * {granular(RADIUS / 2, mass / 2)}"
fix wx all {wall} xplane 0 {width}
fix wy all {wall} yplane 0 {width}
fix wz all {wall} zplane 0 NULL
fix g all gravity {GRAVITY} vector 0 0 -1
fix move all nve/sphere
neighbor 0.006 bin
neigh_modify delay 0 every 20 check yes
timestep {STEP}
compute c all contact/atom
compute cs all reduce ave c_c
thermo_style custom step atoms ke c_cs
thermo_modify lost error flush yes
thermo $(v_steps/10)
run ${{steps}}
print "FINAL mean height $(xcm(all,z))"
""")
