"""Frond from Python: scenes, structures and fields as numpy arrays, over the C library by ctypes.

    import frond
    scene = frond.Scene("cantilever_fluid.yaml", sph_viscosity=5)
    while scene.t < scene.end:
        scene.step()
    print(scene.beam("rod").positions[-1])

Units are SI. Arrays named as views share the library's memory: they show the present state without a copy, and are valid until the
next step. Errors of the library are frond.Error with its one line. With petsc4py, import and initialise it first (or let this module
do it): both then use the same PETSc, and a view wrapped by PETSc.Vec().createWithArray(view) is a vector without a copy.

The library is libfrond.so from $FROND_LIBRARY, from the prefix that this file is installed under, or from where the system finds it.
"""
import ctypes
import ctypes.util
import glob
import os

import numpy as np

__all__ = ["Error", "Scene", "Beams", "State", "sweep", "call", "library"]


class Error(RuntimeError):
    """An error of the library: .code is PETSc's number of it."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


def _find():
    here = os.path.dirname(os.path.abspath(__file__))
    if os.environ.get("FROND_LIBRARY"):
        return os.environ["FROND_LIBRARY"]
    prefix = os.path.normpath(os.path.join(here, "..", "..", ".."))  # of <prefix>/share/frond/python
    for pattern in ("lib*/libfrond.so", "lib*/*/libfrond.so"):
        for name in sorted(glob.glob(os.path.join(prefix, pattern))):
            return name
    name = ctypes.util.find_library("frond")
    if not name:
        raise ImportError("libfrond.so was not found: set FROND_LIBRARY to its path")
    return name


def _start_petsc(lib):
    """PETSc through petsc4py when that is there, so that both share it; else by itself."""
    try:
        import petsc4py

        petsc4py.init([])
        from petsc4py import PETSc  # noqa: F401
    except ImportError:
        pass
    done = ctypes.c_int(0)
    lib.PetscInitialized(ctypes.byref(done))
    if not done.value and lib.PetscInitializeNoArguments():
        raise ImportError("PETSc could not be initialised")


library = ctypes.CDLL(_find(), mode=ctypes.RTLD_GLOBAL)
_start_petsc(library)

_sizes = (ctypes.c_int * 2)()
library.FrondGetSizes.restype = None
library.FrondGetSizes(ctypes.byref(_sizes, 0), ctypes.byref(_sizes, 4))
Int = ctypes.c_int64 if _sizes[0] == 8 else ctypes.c_int32
Real = ctypes.c_double if _sizes[1] == 8 else ctypes.c_float
_int = np.dtype(Int)
_real = np.dtype(Real)

_HANDLER = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_int, ctypes.c_char_p, ctypes.c_void_p
)
_message = [None]


def _remember(comm, line, function, file, code, kind, text, context):
    if text and _message[0] is None:
        _message[0] = text.decode(errors="replace").strip()
    return code


_handler = _HANDLER(_remember)


def call(name, *arguments):
    """The C function `name` of Frond's headers, or of PETSc, that returns a PetscErrorCode; raises Error when it fails."""
    _message[0] = None
    library.PetscPushErrorHandler(_handler, None)
    try:
        code = getattr(library, name)(*arguments)
    finally:
        library.PetscPopErrorHandler()
    if code:
        raise Error(code, _message[0] or "%s failed with the error %d" % (name, code))


def _view(pointer, shape, dtype=None):
    """An array over memory of the library."""
    n = int(np.prod(shape))
    if not pointer or n == 0:
        return np.empty(shape, dtype or _real)
    ctype = Real if dtype is None else Int
    return np.ctypeslib.as_array(ctypes.cast(pointer, ctypes.POINTER(ctype)), (n,)).reshape(shape)


def _array(a):
    return a.ctypes.data_as(ctypes.c_void_p)


class _BeamSpec(ctypes.Structure):
    _fields_ = [
        ("start", Real * 3), ("end", Real * 3), ("elements", Int), ("diameter", Real), ("density", Real), ("young", Real),
        ("axialdamping", Real), ("bendingdamping", Real), ("EA", Real), ("EI", Real), ("rhoA", Real), ("inner", Real), ("width", Real), ("thickness", Real), ("pretension", Real),
        ("curvature", Real), ("normal", Real * 3), ("curve", ctypes.POINTER(Real)), ("curvelength", Real), ("velocity", Real * 3), ("end0", ctypes.c_int), ("end1", ctypes.c_int),
    ]


class _Fields(ctypes.Structure):
    _fields_ = [(name, ctypes.c_void_p) for name in ("x", "v", "a", "rho", "p", "group")]


class _Audit(ctypes.Structure):
    _fields_ = [("force", Real * 3), ("moment", Real * 3), ("power", Real), ("force_lost", Real * 3), ("moment_lost", Real * 3),
                ("power_lost", Real), ("twist", Real)]


ENDS = {"free": 0, "pin": 1, "clamp": 2}


class Beams:
    """ANCF beams by themselves (ancf.h): Beams(), add(), setup(), then advance() under loads, in vacuum."""

    def __init__(self, handle=None):
        self._own = handle is None
        self._h = handle or ctypes.c_void_p()
        if self._own:
            call("AncfCreate", _comm_self(), ctypes.byref(self._h))

    def add(self, start, end, elements, diameter, density, young, end0="free", end1="free", velocity=(0, 0, 0), **more):
        """A beam between two points (m); diameter m, density kg/m^3, young Pa; ends free, pin or clamp. Its number.

        more: other numbers of AncfBeamSpec by name (EA, EI, rhoA, inner, width, thickness, pretension, curvature, axialdamping,
        bendingdamping), and normal, a triple.
        """
        spec, number = _BeamSpec(), Int()
        call("AncfBeamSpecInit", ctypes.byref(spec))
        spec.start, spec.end, spec.velocity = (Real * 3)(*start), (Real * 3)(*end), (Real * 3)(*velocity)
        spec.elements, spec.diameter, spec.density, spec.young = elements, diameter, density, young
        spec.end0, spec.end1 = ENDS[end0], ENDS[end1]
        for key, value in more.items():
            if key not in ("EA", "EI", "rhoA", "inner", "width", "thickness", "pretension", "curvature", "normal", "axialdamping", "bendingdamping"):
                raise TypeError("add() got an unexpected keyword argument '%s'" % key)
            setattr(spec, key, (Real * 3)(*value) if key == "normal" else value)
        call("AncfAddBeam", self._h, ctypes.byref(spec), ctypes.byref(number))
        return number.value

    def setup(self, gravity=(0, 0, 0), substeps=1):
        """Gravity in m/s^2; steps of the integrator in one advance()."""
        call("AncfSetGravity", self._h, (Real * 3)(*gravity))
        call("AncfSetSubsteps", self._h, Int(substeps))
        call("AncfSetFromOptions", self._h)
        call("AncfSetUp", self._h)
        return self

    def _state(self):
        t, p = Real(), [ctypes.c_void_p() for _ in range(3)]
        call("AncfGetState", self._h, ctypes.byref(t), *[ctypes.byref(x) for x in p])
        n = Int()
        call("AncfGetNumNodes", self._h, ctypes.byref(n))
        return t.value, [_view(x, (n.value, 6)) for x in p]

    @property
    def t(self):
        """Time, s."""
        return self._state()[0]

    @property
    def coordinates(self):
        """Views: position (m) and position gradient of every node, nodes x 6; likewise their first and second rates."""
        return self._state()[1]

    @property
    def loads(self):
        """View to write to: generalised forces on the nodal coordinates, nodes x 6, N and N m, over the next advance()."""
        p = ctypes.c_void_p()
        call("AncfGetLoads", self._h, ctypes.byref(p))
        return _view(p, self._state()[1][0].shape)

    @property
    def energy(self):
        """Kinetic, elastic and potential energy, J."""
        e = [Real() for _ in range(3)]
        call("AncfGetEnergy", self._h, *[ctypes.byref(x) for x in e])
        return tuple(x.value for x in e)

    def advance(self, t):
        """Integrate to the time t (s)."""
        call("AncfAdvance", self._h, Real(t))

    def nodes(self, beam):
        """The slice of nodes that belong to a beam."""
        spec, first, length = _BeamSpec(), Int(), Real()
        call("AncfGetBeam", self._h, Int(beam), ctypes.byref(spec), ctypes.byref(first), ctypes.byref(length))
        return slice(first.value, first.value + spec.elements + 1)

    def close(self):
        if self._own and self._h:
            call("AncfDestroy", ctypes.byref(self._h))

    def __enter__(self):
        return self

    def __exit__(self, *exc):
        self.close()


def _comm_self():
    """MPI_COMM_SELF as C passes it."""
    try:  # Open MPI: a pointer to a global object
        return ctypes.c_void_p(ctypes.addressof(ctypes.c_byte.in_dll(library, "ompi_mpi_comm_self")))
    except ValueError:
        return ctypes.c_int(0x44000001)  # MPICH and its kin


class Beam:
    """One beam of a scene, its arrays views (n nodes)."""

    def __init__(self, beams, number, name):
        self._beams, self._nodes, self.name = beams, beams.nodes(number), name

    @property
    def positions(self):
        """n x 3, m."""
        return self._beams.coordinates[0][self._nodes, :3]

    @property
    def velocities(self):
        """n x 3, m/s."""
        return self._beams.coordinates[1][self._nodes, :3]


class Body:
    """One rigid body of a scene."""

    def __init__(self, handle, number, name):
        self._h, self._i, self.name = handle, Int(number), name

    def _state(self):
        out = [np.empty(k, _real) for k in (3, 4, 3, 3)]
        call("RigidGetState", self._h, self._i, *[_array(a) for a in out])
        return out

    position = property(lambda self: self._state()[0], doc="Centre of mass, m.")
    quaternion = property(lambda self: self._state()[1], doc="Orientation, see rigid.h.")
    velocity = property(lambda self: self._state()[2], doc="m/s.")
    omega = property(lambda self: self._state()[3], doc="Angular velocity, space frame, rad/s.")


class State:
    """A moment of a scene to go back to (CoupleSaveState())."""

    def __init__(self):
        self._h = ctypes.c_void_p()

    def __del__(self):
        if self._h:
            library.CoupleStateDestroy(ctypes.byref(self._h))


class Scene:
    """A scene file of the frond command. Options as keywords win over the file: Scene("a.yaml", sph_dp=0.02)."""

    def __init__(self, file, **options):
        self._h = ctypes.c_void_p()
        flat = []
        for key, value in options.items():
            if isinstance(value, (list, tuple)):
                value = ",".join(str(v) for v in value)
            if isinstance(value, bool):
                value = str(value).lower()
            flat += [key.encode(), str(value).encode()]
        strings = (ctypes.c_char_p * max(1, len(flat)))(*flat)
        call("FrondSceneLoad", os.fsencode(file), Int(len(options)), strings, ctypes.byref(self._h))
        objects = [ctypes.c_void_p() for _ in range(4)]
        call("FrondSceneGetObjects", self._h, *[ctypes.byref(o) for o in objects])
        self._couple, self._sph, ancf, self._rigid = objects
        self.beams = self._list("FrondSceneGetBeamName", "AncfGetNumBeams", ancf, lambda i, name: Beam(Beams(ancf), i, name))
        self.bodies = self._list("FrondSceneGetBodyName", "RigidGetNumBodies", self._rigid, lambda i, name: Body(self._rigid, i, name))
        self.surfaces = [s for s in self._list("FrondSceneGetSurfaceName", None, self._couple, lambda i, name: name)]

    def _name(self, getter, i):
        name = ctypes.c_char_p()
        call(getter, self._h, Int(i), ctypes.byref(name))
        return name.value.decode()

    def _list(self, getter, counter, handle, make):
        n = Int()
        if handle and counter:
            call(counter, handle, ctypes.byref(n))
        elif handle:
            call("FrondSceneGetNumSurfaces", self._h, ctypes.byref(n))
        return [make(i, self._name(getter, i)) for i in range(n.value)]

    def beam(self, name):
        return next(b for b in self.beams if b.name == name)

    def body(self, name):
        return next(b for b in self.bodies if b.name == name)

    def _time(self):
        t, step, end = Real(), Int(), Real()
        call("FrondSceneGetTime", self._h, ctypes.byref(t), ctypes.byref(step), ctypes.byref(end))
        return t.value, step.value, end.value

    t = property(lambda self: self._time()[0], doc="Time, s.")
    steps = property(lambda self: self._time()[1], doc="Number of steps so far.")
    end = property(lambda self: self._time()[2], doc="time_end of the scene, s.")

    def step(self, tmax=None):
        """One step, not past tmax (s; default: the scene's end); the step taken, s."""
        dt = Real()
        call("FrondSceneStep", self._h, Real(self.end if tmax is None else tmax), ctypes.byref(dt))
        return dt.value

    def advance(self, t):
        """Steps to the time t (s)."""
        while self.t < t - 1e-12 * max(1.0, abs(t)):
            self.step(t)

    def fields(self, *names):
        """Copies of the markers' fields, fluid first, as a dict of arrays: x, v, a (n x 3; m, m/s, m/s^2), rho (kg/m^3), p (Pa), group
        (-1 fluid, -2 left, else boundary)."""
        fluid, boundary, f, out = Int(), Int(), _Fields(), {}
        call("SphGetCounts", self._sph, ctypes.byref(fluid), ctypes.byref(boundary), None)
        n = fluid.value + boundary.value
        for name in names or ("x", "v", "rho", "p", "group"):
            out[name] = np.empty((n, 3) if name in "xva" else n, _int if name == "group" else _real)
            setattr(f, name, out[name].ctypes.data)
        call("SphGetFields", self._sph, ctypes.byref(f))
        return out

    def sample(self, points):
        """Velocity (n x 3, m/s) and pressure (n, Pa) of the fluid at points (n x 3, m); NaN where there is none."""
        x = np.ascontiguousarray(points, _real).reshape(-1, 3)
        v, p = np.empty_like(x), np.empty(len(x), _real)
        call("SphSample", self._sph, Int(len(x)), _array(x), _array(v), _array(p))
        return v, p

    def markers(self, surface):
        """Views of a surface's markers by its name: positions (m), velocities (m/s), forces of the last step (N), n x 3."""
        n, p = Int(), [ctypes.c_void_p() for _ in range(3)]
        call("CoupleGetMarkers", self._couple, Int(self.surfaces.index(surface)), ctypes.byref(n), *[ctypes.byref(x) for x in p])
        return [_view(x, (n.value, 3)) for x in p]

    def load(self, surface):
        """What the fluid did to a surface in the last step: dict of force (N), moment about the origin (N m), power (W), and what the
        transfer to the structure lost of them."""
        a = _Audit()
        call("CoupleGetAudit", self._couple, Int(self.surfaces.index(surface)), ctypes.byref(a))
        return {k: (np.array(v[:]) if hasattr(v, "__len__") else v) for k, v in ((f[0], getattr(a, f[0])) for f in _Audit._fields_)}

    def save(self, state=None):
        """Keep this moment, for restore()."""
        state = state or State()
        call("CoupleSaveState", self._couple, ctypes.byref(state._h))
        return state

    def restore(self, state):
        """Back to a moment kept by save(): the run goes on with the same bits."""
        call("CoupleRestoreState", self._couple, state._h)

    def close(self):
        if self._h:
            call("FrondSceneDestroy", ctypes.byref(self._h))

    def __enter__(self):
        return self

    def __exit__(self, *exc):
        self.close()


def sweep(file, option, values, measure, t=None, **options):
    """For every value of an option: load the scene, advance it to t (default: its end), and take measure(scene). List of results."""
    results = []
    for value in values:
        with Scene(file, **{option: value}, **options) as scene:
            scene.advance(scene.end if t is None else t)
            results.append(measure(scene))
    return results
