"""What ParaView's reader sees of a run: times, blocks, points, arrays, and numbers equal to the HDF5 files'. Run by pvpython."""
import os
import sys

import h5py
import numpy as np
from paraview import servermanager
from paraview.simple import XDMFReader
from vtkmodules.util.numpy_support import vtk_to_numpy

checks = failures = 0


def check(ok, text):
    global checks, failures
    checks += 1
    if not ok:
        failures += 1
        print("FAILED: " + text)


def blocks(data, found, name=""):
    if data.IsA("vtkMultiBlockDataSet"):
        for i in range(data.GetNumberOfBlocks()):
            meta = data.GetMetaData(i)
            blocks(data.GetBlock(i), found, meta.Get(data.NAME()) if meta and meta.Has(data.NAME()) else str(i))
    else:
        found[name.split("[")[0]] = data
    return found


def compare(data, h5, fields, what):
    check(np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), h5["position"][:].astype(vtk_to_numpy(data.GetPoints().GetData()).dtype)), what + ": positions")
    for field in fields:
        array = data.GetPointData().GetArray(field)
        check(array is not None and np.array_equal(vtk_to_numpy(array), h5[field][:]), what + ": " + field)


run = sys.argv[1]
reader = XDMFReader(FileNames=[os.path.join(run, "run.xdmf")])
reader.UpdatePipelineInformation()
times = list(reader.TimestepValues)
check(len(times) == 6 and abs(times[-1] - 0.01) < 1e-12, "times %s" % times)
for k in (0, 3, 5):
    reader.UpdatePipeline(times[k])
    found = blocks(servermanager.Fetch(reader), {})
    check(set(found) == {"markers", "rod", "bodies"}, "blocks %s" % sorted(found))
    with h5py.File(os.path.join(run, "frame_%05d.h5" % k), "r") as h:
        n = len(h["markers/position"])
        check(found["markers"].GetNumberOfCells() == n and found["markers"].GetCellType(0) in (1, 2), "frame %d: %d vertices" % (k, n))
        compare(found["markers"], h["markers"], ("velocity", "density", "pressure", "group"), "frame %d markers" % k)
        check(found["rod"].GetNumberOfCells() == 1 and found["rod"].GetCellType(0) == 4, "frame %d: the beam is one polyline" % k)
        compare(found["rod"], h["beams/rod/line"], ("velocity", "stretch", "coordinate", "axial_force", "curvature", "moment"),
                "frame %d beam" % k)
        compare(found["bodies"], h["bodies"], ("velocity", "omega"), "frame %d bodies" % k)
print("%d checks, %d failed" % (checks, failures))
sys.exit(1 if failures or not checks else 0)
