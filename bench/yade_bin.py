"""The bin of apples of bench/scene_bin.py on YADE: its Hertz-Mindlin contact, one thread.

    yade -n -x -j1 bench/yade_bin.py BIN_TXT STEPS

Prints contacts per fruit and particle-steps per second of processor time in the last tenth.
"""

import sys
import time

import numpy as np

initial, steps = sys.argv[1], int(sys.argv[2])
K, RADIUS, POISSON = 753599.0, 0.0375, 0.3
fruit = np.loadtxt(initial)
count = len(fruit)
with open(initial) as text:
    side = float(text.readline().split()[2])
# k of two apples is 4/3 E* sqrt(R*), E* = E/(2 (1 - nu^2)).
young = 0.75 * K / np.sqrt(RADIUS / 2) * 2 * (1 - POISSON**2)
apple = O.materials.append(
    FrictMat(young=young, poisson=POISSON, density=840, frictionAngle=np.arctan(0.3))
)
for row in fruit:
    body = sphere(row[1:4], row[7], material=apple)
    O.bodies.append(body)
    body.state.vel = row[4:7]
for axis, place in ((0, 0), (0, side), (1, 0), (1, side), (2, 0)):
    O.bodies.append(wall(place, axis=axis, material=apple))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.003),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.35)],
        [Law2_ScGeom_MindlinPhys_Mindlin()],
    ),
    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),
]
O.dt = 2e-5
O.run(steps - steps // 10, True)
start = time.process_time()
O.run(steps // 10, True)
spent = time.process_time() - start
real = sum(1 for own in O.interactions if own.isReal and max(own.id1, own.id2) < count)
print(f"YADE {1e-6 * count * (steps // 10) / spent:.3f} contacts {2 * real / count:.3f}")
