"""Impacts on YADE with the contacts that windfall wrote: WINDFALL_IMPACTS names a file of JSON with
the contacts, the bodies and the speeds; prints a line for each impact."""
import json
import os

from yade import *  # noqa: F403

task = json.load(open(os.environ["WINDFALL_IMPACTS"]))
tables = {"hertz": {}, "viscoelastic": {}}
exec(open(task["contacts"]).read(), tables)
radius, density = task["radius"], task["density"]


def material(kind, own):
    if kind == "hertz":
        return FrictMat(young=own["young"], poisson=own["poisson"], density=density,
                        frictionAngle=own["frictionAngle"])
    return ViscElMat(kn=own["kn"], ks=own["ks"], cn=own["cn"], cs=own["cs"], density=density,
                     frictionAngle=own["frictionAngle"])


def impact(kind, own, wall, speed):
    O.reset()
    O.materials.append(material(kind, own))
    if wall:
        O.bodies.append(utils.wall((0, 0, 0), axis=2, material=0))
        O.bodies.append(sphere((0, 0, radius + 1e-7), radius, material=0))
    else:
        O.bodies.append(sphere((0, 0, 0), radius, material=0))
        O.bodies.append(sphere((0, 0, 2 * radius + 1e-7), radius, material=0))
    if kind == "hertz":
        physics = Ip2_FrictMat_FrictMat_MindlinPhys(en=MatchMaker(algo="val", val=own["en"]))
        law = Law2_ScGeom_MindlinPhys_Mindlin()
    else:
        physics, law = Ip2_ViscElMat_ViscElMat_ViscElPhys(), Law2_ScGeom_ViscElPhys_Basic()
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [physics], [law]),
        NewtonIntegrator(damping=0),
    ]
    O.dt = 1e-6
    O.bodies[1].state.vel = (0, 0, -speed)
    touched = False
    # In long runs: each waits for a thread of its own.
    for _ in range(60):
        O.run(500, True)
        touching = any(own.isReal for own in O.interactions)
        if touched and not touching:
            break
        touched = touched or touching
    parts = O.bodies[1].state.vel[2] - (0 if wall else O.bodies[0].state.vel[2])
    return parts / speed


for kind in ("hertz", "viscoelastic"):
    for (a, b), own in tables[kind].items():
        for speed in task["speeds"]:
            restitution = impact(kind, own, b == "steel", speed)
            print("IMPACT", json.dumps([a, b, speed, restitution]), flush=True)
os._exit(0)
