"""Reads every VTP file of a scene with VTK's own reader and compares it with frames.bin.

    python check_vtk.py RUN        # after `windfall scene vtk RUN`; needs `vtk` and `numpy`
"""

import json
import struct
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

FRUIT = np.dtype(
    [
        ("fruit", "<u4"),
        ("place", "<f4", 3),
        ("turn", "<f4", 4),
        ("velocity", "<f4", 3),
        ("peak_force", "<f4"),
    ]
)


def frames(path):
    """Radii, walls, and time and fruit of each frame."""
    data = open(path, "rb").read()
    (length,) = struct.unpack_from("<I", data, 12)
    about = json.loads(data[16 : 16 + length])
    at = 16 + length
    radii = np.frombuffer(data, "<f4", about["fruit"], at)
    at += 4 * about["fruit"]
    for wall in about["walls"]:
        at += 12 * wall["vertices"] + 4 * wall["corners"] * wall["faces"]
    found = []
    while at < len(data):
        magic, count, time = struct.unpack_from("<4sId", data, at)
        assert magic == b"frme"
        at += 16 + 28 * len(about["walls"])
        found.append((time, np.frombuffer(data, FRUIT, count, at)))
        at += 48 * count
    return radii, about["walls"], found


def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


def main(run):
    radii, walls, found = frames(run + "/frames.bin")
    sets = ElementTree.parse(run + "/vtk/scene.pvd").getroot().findall(".//DataSet")
    fruit = [own for own in sets if own.get("name") == "fruit"]
    assert len(fruit) == len(found)
    for own, (time, frame) in zip(fruit, found):
        data = read(run + "/vtk/" + own.get("file"))
        assert float(own.get("timestep")) == time
        assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == len(frame)
        if len(frame) == 0:
            continue
        points = data.GetPointData()
        for name, expected in {
            "radius": radii[frame["fruit"] - 1],
            "velocity": frame["velocity"],
            "largest_peak_force": frame["peak_force"],
            "orientation": frame["turn"],
            "fruit": frame["fruit"],
        }.items():
            assert (vtk_to_numpy(points.GetArray(name)) == expected).all(), name
        assert (vtk_to_numpy(data.GetPoints().GetData()) == frame["place"]).all()
    for own in (own for own in sets if own.get("name") == "walls"):
        data = read(run + "/vtk/" + own.get("file"))
        assert data.GetNumberOfPolys() == sum(wall["faces"] for wall in walls)
        names = data.GetFieldData().GetAbstractArray("names")
        assert [names.GetValue(k) for k in range(len(walls))] == [w["name"] for w in walls]
    print(len(found), "frames as VTK reads them are those of frames.bin")


main(sys.argv[1])
