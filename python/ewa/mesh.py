# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Files of points or triangles, and meshes into surfels."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

from . import _bindings as b
from ._arrays import Array, as_colors, as_contiguous, as_numbers, as_points, export, exported
from ._context import Context, Core, Handle, Pin, check_pins, core_of
from ._errors import ArgumentError, ClosedError, FormatError
from ._keywords import keywords
from ._library import functions as lib
from ._scene import is_path
from ._struct import Source, fill, initialised, loader, numbers, path_bytes
from .camera import PathLike
from .cloud import MEANT, Cloud, borrowed, merge_clouds
from .image import as_picture, linear_of_codes, pixels_struct
from .octree import Octree, is_folder

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import CloudSaveOptions, MeshSampleOptions

# A mesh is drawn from at least so many points, and from so many per triangle.
_MESH_POINTS, _MESH_POINTS_PER_TRIANGLE = 200000, 4


class Mesh:
    """Triangles over shared vertices.

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
        World units.
    triangles : array_like of int, shape (m, 3)
        Counter-clockwise seen from outside.
    normals : array_like, shape (n, 3), optional
        Outward, any length; zero: none there.
    colors : array_like, shape (n, 3) or (n, 4), optional
        Red, green, blue, straight alpha: whole numbers are sRGB over their whole range, floats linear light.
    texcoords : array_like, shape (n, 2), optional
        Places in the pictures, (0, 0) at the bottom left, (1, 1) at the top right; pictures repeat.
    materials : sequence of (color, picture), optional
        Of a material the linear colour (r, g, b, a) and the path or array of its picture, or None; these and the colours of
        the vertices are multiplied.
    triangle_materials : array_like of int, shape (m,), optional
        Which material each triangle has. Default: 0.
    **attributes
        Further numbers of the vertices, arrays of shape (n,) or (n, 1) to (n, 4), which points on the triangles get by their
        names: between the corners, of whole numbers those of the nearest corner.

    Raises
    ------
    ArgumentError
        A shape or type that does not fit, a vertex that is not there.
    """

    _handle: Handle | None

    def __init__(self, vertices: Any, triangles: Any, *, normals: Any = None, colors: Any = None, texcoords: Any = None,
                 materials: Sequence[tuple[Sequence[float], Any]] | None = None, triangle_materials: Any = None,
                 context: Context | None = None, **attributes: Any) -> None:
        core = core_of(context)
        positions = as_contiguous(vertices, np.float64, (None, 3), "vertices")
        corners = _whole(triangles, 2, "triangles")
        if corners.shape[1] != 3:
            raise ArgumentError(f"triangles: shape {corners.shape}; (m, 3) is needed")
        if corners.size and (int(corners.min()) < 0 or int(corners.max()) >= len(positions)):
            raise ArgumentError(f"triangles: a vertex outside of the {len(positions)} that there are")
        if max(len(positions), len(corners)) >= 2**32:
            raise ArgumentError("vertices: 2^32 or more")
        corners = np.ascontiguousarray(corners, np.uint32)
        arrays = [positions, corners]
        self._mesh = b.ewa_mesh(context=core.address, vertex_count=len(positions), triangle_count=len(corners),
                                positions=positions.ctypes.data, triangles=corners.ctypes.data)
        colors = None if colors is None else _linear_colors(colors)
        for name, value, width in (("normals", normals, 3), ("colors", colors, 4), ("texcoords", texcoords, 2)):
            if value is not None:
                arrays.append(as_contiguous(value, np.float32, (len(positions), width), name))
                setattr(self._mesh, name, arrays[-1].ctypes.data)
        self._materials: tuple[Any, ...] = ()
        keep: tuple[Any, ...] = ()
        if attributes:
            for name in attributes:
                if name in MEANT:
                    raise ArgumentError(f"{name}: points on triangles have that of their own")
            numbers_of = borrowed(core, {name: as_points(value, name, None) for name, value in attributes.items()}, len(positions))
            self._mesh.attributes, keep = numbers_of.address, (numbers_of,)
        if materials:
            arrays += self._set_materials(materials, triangle_materials)
        self._handle = Handle(core, None, lib.ewa_mesh_free, "the mesh",
                              keep + tuple(Pin(array, "mesh") for array in arrays))

    def _set_materials(self, materials: Sequence[tuple[Sequence[float], Any]], of_triangles: Any) -> list[Array]:
        """Fill in the materials; returns the arrays that the struct borrows."""
        mesh, count = self._mesh, len(materials)
        which = np.zeros(mesh.triangle_count, np.uint32)
        if of_triangles is not None:
            given = _whole(of_triangles, 1, "triangle_materials")
            if len(given) != len(which) or (given.size and not 0 <= int(given.min()) <= int(given.max()) < count):
                raise ArgumentError(f"triangle_materials: {len(which)} numbers from 0 to {count - 1} are needed")
            which = np.ascontiguousarray(given, np.uint32)
        made, textures, arrays = (b.ewa_mesh_material * count)(), (b.ewa_image * count)(), [which]
        for i, (color, picture) in enumerate(materials):
            made[i].base_color[:] = list(numbers(color, 4, f"materials[{i}]"))
            made[i].texture = i
            if picture is not None:
                arrays.append(as_picture(picture, f"materials[{i}]"))
                textures[i] = pixels_struct(arrays[-1], mesh.context)
        if len(arrays) > 1 and not mesh.texcoords:
            raise ArgumentError("texcoords: pictures of materials need them")
        mesh.material_count, mesh.triangle_materials = count, which.ctypes.data
        mesh.materials, mesh.textures = made, textures
        self._materials = (made, textures)
        return arrays

    @staticmethod
    def _loaded(model: _Model) -> Mesh:
        mesh = Mesh.__new__(Mesh)
        mesh._mesh = model.struct.mesh
        mesh._handle = model.handle
        return mesh

    @property
    def _h(self) -> Handle:
        if self._handle is None:
            raise ClosedError("the mesh is closed")
        return self._handle

    def _plane(self, address: int | None, count: int, width: int, dtype: Any) -> Array:
        if self._h.core.closed:
            raise ClosedError("the context is closed")
        return export(self._h, address, (count, width), np.dtype(dtype))

    @property
    def vertices(self) -> Array:
        """World units; float64, shape (n, 3); read-only."""
        return self._plane(self._mesh.positions, self._mesh.vertex_count, 3, np.float64)

    @property
    def triangles(self) -> Array:
        """Vertices of each; uint32, shape (m, 3); read-only."""
        return self._plane(self._mesh.triangles, self._mesh.triangle_count, 3, np.uint32)

    @property
    def attributes(self) -> dict[str, Array]:
        """Further numbers of the vertices by their names; shape (n,) or (n, k); read-only."""
        def read(_: int | None) -> list[b.ewa_attribute]:
            cloud = self._mesh.attributes
            count = lib.ewa_cloud_attribute_count(cloud) if cloud else 0
            return [b.ewa_attribute.from_buffer_copy(lib.ewa_cloud_attribute_at(cloud, i).contents) for i in range(count)]

        return {attribute.name.decode(): exported(self._h, attribute, self._mesh.vertex_count)
                for attribute in self._h.core.value(read, None)}

    @property
    def closed(self) -> bool:
        """Whether the mesh bounds a solid."""
        result = ctypes.c_bool()
        self._call(lib.ewa_mesh_is_closed, ctypes.byref(result))
        return result.value

    def _call(self, function: Any, *arguments: Any) -> None:
        self._h.core.call(self._bound(function), *arguments)

    def _bound(self, function: Any) -> Any:
        """A function with the mesh as its first argument, for a call in which it cannot go away."""
        handle = self._h

        def checked(*given: Any) -> int:
            if not self._mesh.context or (handle.address is None and not handle.keep):
                raise ClosedError("the mesh is closed")
            check_pins(handle)
            status: int = function(ctypes.byref(self._mesh), *given)
            return status

        return checked

    def _asset_members(self) -> dict[str, Any]:
        return {"mesh": self}

    @keywords("ewa_mesh_sample_options")
    def sample(self, **options: Unpack[MeshSampleOptions]) -> Cloud:
        """Return surfels on the triangles, sharp edges as clip lines.

        Parameters
        ----------
        **options

        Raises
        ------
        ArgumentError, NumericError, OutOfMemory
        """
        made = initialised(b.ewa_mesh_sample_options, lib.ewa_mesh_sample_options_init)
        fill(made, "ewa_mesh_sample_options", options)
        return Cloud._made(self._h.core, self._bound(lib.ewa_mesh_sample), ctypes.byref(made))

    def __reduce__(self) -> Any:
        mesh, streams = self._mesh, dict(self.attributes)
        for name, width in (("normals", 3), ("colors", 4), ("texcoords", 2)):
            if getattr(mesh, name):
                streams[name] = self._plane(getattr(mesh, name), mesh.vertex_count, width, np.float32)
        materials = []
        for i in range(mesh.material_count):
            picture = mesh.textures[mesh.materials[i].texture]
            shape = (picture.height_px, picture.width_px, picture.channel_count)
            materials.append((list(mesh.materials[i].base_color), export(self._h, picture.pixels, shape, np.dtype(np.float32))
                              if picture.pixels else None))
        if materials:
            streams["triangle_materials"] = self._plane(mesh.triangle_materials, mesh.triangle_count, 1, np.uint32)[:, 0]
        return _restore, (self.vertices, self.triangles, materials, streams)

    def close(self) -> None:
        """Free the mesh; later use raises ClosedError."""
        self._handle = None

    def __repr__(self) -> str:
        if self._handle is None:
            return "<ewa.Mesh, closed>"
        return f"<ewa.Mesh of {self._mesh.triangle_count} triangles, {self._mesh.vertex_count} vertices>"


def _restore(vertices: Array, triangles: Array, materials: Any, streams: Any) -> Mesh:
    """The mesh of a pickle, in the default context."""
    return Mesh(vertices, triangles, materials=materials, **streams)


def _whole(value: Any, dimensions: int, label: str) -> Array:
    array = as_numbers(value, label)
    if array.dtype.kind not in "iu" or array.ndim != dimensions:
        raise ArgumentError(f"{label}: {array.dtype} of shape {array.shape}; whole numbers of {dimensions} dimensions are "
                            "needed")
    return array


def _linear_colors(value: Any) -> Array:
    """Colours of vertices: linear light, four components."""
    colors = as_colors(value, "colors")
    if colors.ndim != 2 or colors.shape[1] not in (3, 4):
        raise ArgumentError(f"colors: shape {colors.shape}; (n, 3) or (n, 4) is needed")
    if colors.dtype.kind == "u":
        colors = linear_of_codes(colors)
    if colors.shape[1] == 3:
        colors = np.concatenate([colors, np.ones((len(colors), 1), colors.dtype)], axis=1)
    return colors


class _Model:
    """What a file holds, until it is taken."""

    def __init__(self, core: Core, path: Source, wanted: int, options: b.ewa_cloud_load_options) -> None:
        self.core = core
        self.path = path
        struct = self.struct = b.ewa_model()
        function, source = loader(lib.ewa_model_load, lib.ewa_model_load_memory, path, named=True)

        def create(*given: Any) -> int:
            status: int = function(*given[:-1], ctypes.byref(struct))
            given[-1]._obj.value = ctypes.addressof(struct)
            return status

        def free(_: Any) -> None:
            lib.ewa_model_free(ctypes.byref(struct))

        self.handle = core.make(create, core.address, *source, wanted, ctypes.byref(options), destroy=free,
                                what="the mesh")

    def take(self, member: str, destroy: Any, what: str) -> Handle:
        """Take a member out, which is the caller's then."""
        def create(_: int, place: Any) -> int:
            place._obj.value = getattr(self.struct, member)
            setattr(self.struct, member, None)
            return 0

        return self.core.make(create, self.handle, destroy=destroy, what=what)

    def take_points(self) -> Cloud:
        cloud = Cloud._of(self.take("points", lib.ewa_cloud_destroy, "the cloud"))
        cloud._name = self.name
        return cloud

    @property
    def name(self) -> bytes | None:
        return _name_of([self.path])


def _name_of(paths: Sequence[Any]) -> bytes | None:
    """The name of files whose kind says what is up; None: it does not."""
    if not all(is_path(path) for path in paths):
        return None
    names = (ctypes.c_char_p * len(paths))(*[path_bytes(path) for path in paths])
    return names[0] if lib.ewa_up_convention_of(len(paths), names) else None


def _load(core: Core, path: Source, wanted: int, keep_going: bool, attributes: Sequence[str] | None,
          columns: Sequence[str] | None, heights: str = "none") -> _Model:
    options = initialised(b.ewa_cloud_load_options, lib.ewa_cloud_load_options_init)
    fill(options, "ewa_cloud_load_options", {"keep_going": keep_going, "heights": heights})
    if attributes is not None:
        options.attributes = ",".join(attributes).encode()
    if columns is not None:
        options.columns = ",".join(columns).encode()
    return _Model(core, path, wanted, options)


def read(path: Source, *more: Source, filter: str | Sequence[str] | None = None, vertices: bool = False,
         keep_going: bool = False, attributes: Sequence[str] | None = None, columns: Sequence[str] | None = None,
         heights: str = "none", context: Context | None = None) -> Cloud:
    """Read points: PLY, LAS, LAZ, COPC, EPT, E57, PCD, PTX, PTS, XYZ, CSV, grids of heights; or a mesh, onto whose faces points are put.

    Parameters
    ----------
    path, *more : path, or the bytes of a file, or a file that is open for bytes
        Several files become one cloud.
    filter : str or sequence of str, optional
        Conditions on attributes that points fulfil, such as ``"classification=2,6"``.
    vertices : bool, optional
        Of a mesh: take its vertices. Default: points on its faces, as many as the program draws.
    keep_going : bool, optional
        Step over damaged pieces of a file, with a warning.
    attributes : sequence of str, optional
        Names of the streams that are wanted besides "position". Default: all.
    columns : sequence of str, optional
        What the columns of a text file are. Default: as its head or its numbers say.
    heights : {"none", "terrain-rgb", "terrarium"}, optional
        What the colours of a picture say: nothing, or heights as in tiles of Mapbox or of Mapzen.
    context : Context, optional

    Raises
    ------
    FileError, FormatError, OutOfMemory
    """
    if more:
        merged = merge_clouds([read(one, filter=filter, vertices=vertices, keep_going=keep_going, attributes=attributes,
                                    columns=columns, heights=heights, context=context) for one in (path, *more)])
        merged._name = _name_of([path, *more])
        return merged
    core = core_of(context)
    if is_path(path) and is_folder(core, path):
        cloud = Octree(path, context=context).read()
        return cloud if filter is None else cloud.filter(*([filter] if isinstance(filter, str) else filter))
    wanted = b.EWA_MODEL_POINTS if vertices else b.EWA_MODEL_MESH
    model = _load(core, path, wanted, keep_going, attributes, columns, heights)
    if model.struct.points:
        cloud = model.take_points()
    else:
        cloud = points_on(Mesh._loaded(model))
        cloud._name = model.name
    if filter is not None:
        cloud = cloud.filter(*([filter] if isinstance(filter, str) else filter))
    return cloud


def read_model(core: Core, source: Source) -> Cloud | Mesh:
    """The mesh of a file, of one without faces the points."""
    model = _load(core, source, b.EWA_MODEL_MESH, False, None, None)
    return model.take_points() if model.struct.points else Mesh._loaded(model)


def points_on(mesh: Mesh) -> Cloud:
    """Points on the faces of a mesh, as many as are drawn of it."""
    count = max(_MESH_POINTS, _MESH_POINTS_PER_TRIANGLE * mesh._mesh.triangle_count)
    return mesh.sample(point_count=count, texture_filter="ewa")


def read_mesh(path: Source, *, context: Context | None = None) -> Mesh:
    """Read triangles: PLY, OBJ, STL, OFF, glTF, VTK; of a path, or of the bytes of a file, which is read alone.

    Raises
    ------
    FileError
    FormatError
        Also a file that has no faces.
    """
    core = core_of(context)
    model = _load(core, path, b.EWA_MODEL_MESH, False, None, None)
    if not model.struct.mesh.triangle_count:
        raise FormatError(f"{path!r}: there are no faces" if is_path(path) else "there are no faces", "EWA_ERROR_FORMAT")
    return Mesh._loaded(model)


@keywords("ewa_mesh_sample_options")
def sample(path: Source, *, context: Context | None = None, **options: Unpack[MeshSampleOptions]) -> Cloud:
    """Read a mesh and return surfels on its faces: :func:`read_mesh`, then :meth:`Mesh.sample`.

    Parameters
    ----------
    path : path, or the bytes of a file, which is read alone
    context : Context, optional
    **options

    Raises
    ------
    FileError, FormatError, ArgumentError, NumericError, OutOfMemory
    """
    return read_mesh(path, context=context).sample(**options)


@keywords("ewa_cloud_save_options")
def convert(source: PathLike, target: PathLike, *, filter: str | Sequence[str] | None = None, crop: Any = None,
            voxel: float | None = None, distance: float | None = None, transform: Any = None,
            columns: Sequence[str] | None = None, context: Context | None = None,
            **options: Unpack[CloudSaveOptions]) -> int:
    """Write a cloud to another file: another format, a part of it, moved. Faces of PLY are kept where all points are.

    Parameters
    ----------
    source, target : path
        The suffix of the target chooses its format.
    filter, columns
        As of :func:`read`.
    crop : array_like, shape (2, 3), optional
        Keep the points within a box.
    voxel, distance : float, optional
        Keep one point per voxel of that size; points at least so far apart; world units.
    transform : array_like, shape (4, 4) or (3, 4), optional
        Map points and directions.
    **options

    Returns
    -------
    int
        Number of points written.

    Raises
    ------
    ArgumentError, FileError, FormatError, OutOfMemory
    """
    core = core_of(context)
    model = _load(core, source, b.EWA_MODEL_POINTS | b.EWA_MODEL_ELEMENTS, False, None, columns)
    cloud = model.take_points()
    before = len(cloud)
    if filter is not None:
        cloud = cloud.filter(*([filter] if isinstance(filter, str) else filter))
    if crop is not None:
        low, high = np.asarray(crop, float).reshape(2, 3)
        cloud = cloud.crop(list(low), list(high))
    if voxel is not None or distance is not None:
        cloud = cloud.thin(voxel=voxel, distance=distance)
    if transform is not None:
        cloud = cloud.transform(transform)
    made = initialised(b.ewa_cloud_save_options, lib.ewa_cloud_save_options_init)
    fill(made, "ewa_cloud_save_options", options)
    if len(cloud) == before and path_bytes(target).lower().endswith(b".ply"):
        made.elements = model.struct.elements
    core.call(lambda cloud, _, *rest: lib.ewa_cloud_save(cloud, *rest), cloud._h, model.handle, path_bytes(target),
              ctypes.byref(made))
    return len(cloud)
