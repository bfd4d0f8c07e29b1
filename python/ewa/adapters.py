# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Objects of other packages, and bytes, as what a scene takes; none of these packages is imported here."""
from __future__ import annotations

import io
from typing import Any, Callable, Mapping, Sequence

import numpy as np

from ._arrays import Array, as_numbers
from ._columns import cloud_of_columns
from ._context import Context, core_of
from ._errors import ArgumentError, FormatError
from ._scene import adapters, is_path
from ._struct import bytes_of
from ._surface import WHITE, Surface, linear_colors, mesh_of, srgb8
from .cloud import Cloud, merge_clouds
from .gaussians import read_gaussians
from .mesh import Mesh, points_on, read, read_model
from .volume import Volume, read_volume

#: What objects of other packages become before meshes are joined.
_Part = Any  # Surface | Cloud | Volume


def as_cloud(value: Any, *, context: Context | None = None) -> Cloud:
    """Return the cloud that something is: of meshes, points on their faces, as many as are drawn.

    Parameters
    ----------
    value : Cloud, Mesh, path, or anything that :func:`as_drawables` takes
    context : Context, optional

    Raises
    ------
    TypeError
        It is no cloud and no mesh.
    ArgumentError, FormatError
    """
    if is_path(value):
        return read(value, context=context)
    found = []
    for drawable in as_drawables(value, context=context):
        if isinstance(drawable, Mesh):
            drawable = points_on(drawable)
        if not isinstance(drawable, Cloud):
            raise TypeError(f"no cloud is made of {_kind(drawable)}")
        found.append(drawable)
    return found[0] if len(found) == 1 else merge_clouds(found)


def as_drawables(value: Any, *, context: Context | None = None) -> list[Any]:
    """Return what a scene draws of something: clouds, meshes, volumes, Gaussians. A scene makes such of what it is given.

    Parameters
    ----------
    value : object
        Of trimesh (meshes with their colours, materials and pictures, clouds, scenes), Open3D (clouds and meshes, tensors
        or not), PyVista (meshes, clouds, images, blocks of these), laspy; tables of pandas or polars, structured arrays,
        dicts of arrays, whose names say what they are; arrays of (n, 3) positions or (nz, ny, nx) voxels, also of PyTorch
        or any other package with DLPack; the bytes of a file, or a file that is open for bytes.
    context : Context, optional

    Returns
    -------
    list
        Of one thing, mostly; all triangles of an object are one mesh.

    Raises
    ------
    TypeError
        Nothing is known of such objects.
    ArgumentError, FormatError
        Their numbers are none of a scene; no file is of such bytes.
    """
    if hasattr(value, "_asset_members"):
        return [value]
    parts = _parts_of(value, context)
    surfaces = [part for part in parts if isinstance(part, Surface)]
    found = [part for part in parts if not isinstance(part, Surface)]
    return ([mesh_of(surfaces, context)] if surfaces else []) + found


def _kind(value: Any) -> str:
    return f"{type(value).__module__}.{type(value).__name__}"


def _parts_of(value: Any, context: Context | None) -> list[_Part]:
    for base in type(value).__mro__:  # classes of users may be derived from those of packages
        make = _PACKAGES.get(base.__module__.split(".")[0])
        if make is not None:
            return make(value, context)
    if bytes_of_file(value) is not None:
        return [_of_bytes(value, context)]
    if isinstance(value, Mapping):
        return [cloud_of_columns(value, context)]
    if isinstance(value, np.ndarray) and value.dtype.names:
        return [cloud_of_columns({name: value[name] for name in value.dtype.names}, context)]
    if hasattr(value, "__array__") or hasattr(value, "__dlpack__"):
        return [_of_array(as_numbers(value, "array"), value, context)]
    if isinstance(value, (list, tuple)) and all(isinstance(number, (int, float)) for number in value):
        raise TypeError("a list is of several things to draw; places in lists are ewa.Cloud([[x, y, z], ...])")
    raise TypeError(f"nothing is drawn of {_kind(value)}; there are paths, arrays, dicts of them, bytes of files, and objects "
                    f"of {', '.join(_PACKAGES)}")


def _of_array(array: Array, value: Any, context: Context | None) -> _Part:
    if array.ndim == 3:
        return Volume(array, context=context)
    if array.ndim == 2 and array.shape[1] == 3:
        return Cloud(value, context=context)
    raise ArgumentError(f"array: shape {array.shape}; (n, 3) positions or (nz, ny, nx) voxels are needed; more columns are said "
                        "what they are: ewa.Cloud(a[:, :3], colors=a[:, 3:6])")


# ---- Bytes -------------------------------------------------------------------------------------------------------


def bytes_of_file(value: Any) -> Any:
    """The value, if it is the bytes of a file, or a file that is open; else None."""
    return value if isinstance(value, (bytes, bytearray, memoryview, io.IOBase)) or (
        hasattr(value, "read") and hasattr(value, "seek")) else None


def _of_bytes(value: Any, context: Context | None) -> Any:
    """Gaussians, a mesh or a cloud, as their bytes say; a volume where these are none of such."""
    data = bytes_of(value) or b""
    try:
        return read_gaussians(data, context=context)
    except FormatError:
        pass
    try:
        return read_model(core_of(context), data)
    except FormatError as error:
        try:
            return read_volume(data, context=context)
        except FormatError:
            raise error from None


# ---- laspy, tables -----------------------------------------------------------------------------------------------


def _of_laspy(las: Any, context: Context | None) -> list[_Part]:
    """What a file of the object has, to the last bit: laspy writes it into memory."""
    if not hasattr(las, "points") or not hasattr(las, "write"):
        raise TypeError(f"laspy: LasData is drawn, not {type(las).__name__}")
    file = io.BytesIO()
    las.write(file)
    cloud = read(file.getvalue(), context=context)
    cloud._name = b"laspy.las"  # what is up in such files
    return [cloud]


def _of_table(table: Any, context: Context | None) -> list[_Part]:
    if not hasattr(table, "columns"):  # a series
        return [_of_array(as_numbers(table, "series"), table, context)]
    return [cloud_of_columns({str(name): table[name] for name in table.columns}, context)]


# ---- trimesh -----------------------------------------------------------------------------------------------------


def _of_trimesh(value: Any, context: Context | None) -> list[_Part]:
    if hasattr(value, "graph") and hasattr(value, "geometry"):
        found: list[_Part] = []
        for node in value.graph.nodes_geometry:
            matrix, name = value.graph[node]
            for part in _of_trimesh(value.geometry[name], context):
                found.append(part.moved(matrix) if isinstance(part, Surface) else part.transform(matrix))
        return found
    if hasattr(value, "faces"):
        return [_of_trimesh_mesh(value)]
    if not hasattr(value, "vertices") or hasattr(value, "entities"):
        raise TypeError(f"trimesh: meshes, clouds and scenes are drawn, not {type(value).__name__}")
    colors = getattr(value, "colors", None)
    some = colors is not None and len(colors) == len(value.vertices)
    return [Cloud(np.asarray(value.vertices), colors=np.asarray(colors, np.uint8) if some else None, context=context)]


def _of_trimesh_mesh(mesh: Any) -> Surface:
    made = Surface(np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces))
    for name, values in dict(getattr(mesh, "vertex_attributes", {})).items():
        made.add_numbers(name, values)
    if "vertex_normals" in getattr(mesh, "_cache", ()):  # those of a file; others are made of the triangles, as here
        made.normals = np.asarray(mesh.vertex_normals)
    visual = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    if kind == "vertex":
        made.colors = linear_colors(visual.vertex_colors)  # type: ignore[union-attr]
    elif kind == "face":
        made = made.apart()
        made.colors = linear_colors(np.repeat(np.asarray(visual.face_colors), 3, axis=0))  # type: ignore[union-attr]
    elif kind == "texture":
        uv = getattr(visual, "uv", None)
        made.texcoords = None if uv is None else np.asarray(uv)
        material = visual.material  # type: ignore[union-attr]
        several = getattr(material, "materials", None)
        made.materials = [_trimesh_material(one, uv is not None) for one in several or [material]]
        which = getattr(visual, "face_materials", None)
        made.triangle_materials = None if which is None or several is None else np.asarray(which)
    return made


def _trimesh_material(material: Any, has_uv: bool) -> tuple[Any, Any]:
    """The linear colour and the picture, sRGB, of a material of glTF or of OBJ, where the picture stands for the colour."""
    if hasattr(material, "baseColorFactor"):
        factor, picture = material.baseColorFactor, material.baseColorTexture
        color = WHITE[0]
        if factor is not None:
            given = np.asarray(factor)
            linear = (given / 255 if given.dtype.kind == "u" else given).astype(np.float32).tolist()
            color = tuple((linear + [1.0])[:4])
    else:
        picture, diffuse = getattr(material, "image", None), getattr(material, "diffuse", None)
        color = WHITE[0] if diffuse is None or picture is not None else tuple(
            linear_colors(np.asarray(diffuse, np.uint8)[None, :])[0].tolist())
    return color, _pixels(picture) if picture is not None and has_uv else None


def _pixels(picture: Any) -> Array:
    """Pixels of a picture of PIL, or of one that numpy takes."""
    if hasattr(picture, "convert") and getattr(picture, "mode", "RGB") not in ("L", "RGB", "RGBA"):
        picture = picture.convert("RGBA" if "transparency" in picture.info or "A" in picture.mode else "RGB")
    return np.asarray(picture)


# ---- Open3D ------------------------------------------------------------------------------------------------------


def _of_open3d(value: Any, context: Context | None) -> list[_Part]:
    if hasattr(value, "point"):  # of open3d.t
        fields = {name: _tensor(value.point[name]) for name in value.point}
        colors = fields.pop("colors", None)
        streams: dict[str, Any] = {name: array[:, 0] if array.ndim == 2 and array.shape[1] == 1 else array
                                   for name, array in fields.items()
                                   if name != "positions" and (array.ndim == 1 or array.shape[1] <= 4)}
        return [Cloud(fields["positions"], colors=_srgb_codes(colors), context=context, **streams)]
    if hasattr(value, "vertex") and hasattr(value, "triangle"):
        made = Surface(_tensor(value.vertex["positions"]), _tensor(value.triangle["indices"]))
        return [_open3d_surface(made, {name: _tensor(value.vertex[name]) for name in value.vertex},
                                {name: _tensor(value.triangle[name]) for name in value.triangle},
                                [_open3d_material(value)])]
    if hasattr(value, "triangles") and hasattr(value, "vertices"):
        made = Surface(np.asarray(value.vertices), np.asarray(value.triangles))
        vertex = {"normals": np.asarray(value.vertex_normals), "colors": np.asarray(value.vertex_colors)}
        triangle = {"texture_uvs": np.asarray(value.triangle_uvs), "material_ids": np.asarray(value.triangle_material_ids)}
        pictures = [None if picture.is_empty() else np.asarray(picture)[::-1] for picture in value.textures]  # v goes down
        return [_open3d_surface(made, vertex, triangle, [(WHITE[0], picture) for picture in pictures])]
    if not hasattr(value, "points") or not hasattr(value, "has_normals"):
        raise TypeError(f"open3d: clouds and triangle meshes are drawn, not {type(value).__name__}")
    return [Cloud(np.asarray(value.points), normals=np.asarray(value.normals) if value.has_normals() else None,
                  colors=_srgb_codes(np.asarray(value.colors)) if value.has_colors() else None, context=context)]


def _tensor(tensor: Any) -> Array:
    return np.asarray(tensor.cpu().numpy())


def _srgb_codes(colors: Array | None) -> Array | None:
    return srgb8(colors) if colors is not None and colors.dtype.kind == "f" else colors


def _open3d_material(mesh: Any) -> tuple[Any, Any]:
    """The picture of a mesh of tensors."""
    material = getattr(mesh, "material", None)
    if material is None or not material.is_valid() or "albedo" not in material.texture_maps:
        return WHITE
    picture = material.texture_maps["albedo"]
    return WHITE[0], None if picture.is_empty() else _tensor(picture.as_tensor())[::-1]


def _open3d_surface(made: Surface, vertex: Mapping[str, Array], triangle: Mapping[str, Array],
                    materials: list[tuple[Any, Any]]) -> Surface:
    """A surface with what is said of its vertices and triangles; empty arrays say nothing."""
    if len(vertex.get("normals", ())):
        made.normals = vertex["normals"]
    if len(vertex.get("colors", ())):
        made.colors = linear_colors(vertex["colors"])
    for name, values in vertex.items():
        if name not in ("positions", "normals", "colors"):
            made.add_numbers(name, values)
    uvs = triangle.get("texture_uvs")
    if uvs is not None and len(uvs) and any(picture is not None for _, picture in materials):
        made = made.apart()
        made.texcoords = np.asarray(uvs).reshape(-1, 2)
        made.materials = materials
        which = triangle.get("material_ids")
        if which is not None and len(which) == len(made.triangles) and len(materials) > 1:
            made.triangle_materials = which.reshape(-1)
    return made


# ---- PyVista -----------------------------------------------------------------------------------------------------

_COLORS = ("RGB", "RGBA", "rgb", "rgba", "colors", "Colors")
_NORMALS = ("Normals", "normals")


def _of_pyvista(value: Any, context: Context | None) -> list[_Part]:
    if hasattr(value, "keys") and hasattr(value, "n_blocks"):
        return [part for block in value if block is not None for part in _of_pyvista(block, context)]
    if hasattr(value, "dimensions") and hasattr(value, "spacing"):
        return [_of_pyvista_image(value, context)]
    if not hasattr(value, "point_data"):
        raise TypeError(f"pyvista: data sets are drawn, not {type(value).__name__}")
    if not hasattr(value, "faces"):
        value = _pyvista_surface(value)
    if not len(value.faces) and not len(value.strips):
        return [_of_pyvista_points(value, context)]
    mesh = value if value.is_all_triangles else value.triangulate()
    made = Surface(np.asarray(mesh.points, np.float64), np.asarray(mesh.faces).reshape(-1, 4)[:, 1:])
    of_points = {name: np.asarray(mesh.point_data[name]) for name in mesh.point_data.keys()}
    of_cells = {name: np.asarray(mesh.cell_data[name]) for name in mesh.cell_data.keys()}
    for name, values in of_points.items():
        if name in _NORMALS:
            made.normals = values
        elif name in _COLORS and values.ndim == 2:
            made.colors = linear_colors(values)
        else:
            made.add_numbers(name, values)
    made = made.apart() if of_cells else made
    for name, values in of_cells.items():
        of_corners = np.repeat(values, 3, axis=0)
        if name in _COLORS and values.ndim == 2:
            made.colors = linear_colors(of_corners) if made.colors is None else made.colors
        elif name not in _NORMALS:
            made.add_numbers(f"cell_{name}" if name in of_points else name, of_corners)
    return [made]


def _pyvista_surface(grid: Any) -> Any:
    """The outside of a grid; versions that have several ways warn where none is chosen."""
    try:
        return grid.extract_surface(pass_pointid=False, pass_cellid=False, algorithm="dataset_surface")
    except TypeError:
        return grid.extract_surface(pass_pointid=False, pass_cellid=False)


def _of_pyvista_points(data: Any, context: Context | None) -> Cloud:
    streams: dict[str, Any] = {}
    for name in data.point_data.keys():
        values = np.asarray(data.point_data[name])
        if values.dtype.kind in "fiub" and (values.ndim == 1 or (values.ndim == 2 and values.shape[1] <= 4)):
            streams["normals" if name in _NORMALS else "colors" if name in _COLORS and values.ndim == 2 else name] = values
    return Cloud(np.asarray(data.points), context=context, **streams)


def _of_pyvista_image(image: Any, context: Context | None) -> Volume:
    """Of points, else of cells, whose middles are half a step further, the numbers that are active, else the first."""
    nx, ny, nz = image.dimensions
    name = getattr(image, "active_scalars_name", None)
    of_points = name in image.point_data if name else bool(len(image.point_data))
    data = image.point_data if of_points else image.cell_data
    names: Sequence[str] = list(data.keys())
    if not names:
        raise ArgumentError("pyvista: the image has no numbers")
    values = np.asarray(data[name if name in names else names[0]])
    if values.ndim == 2:
        raise ArgumentError(f"pyvista: {values.shape[1]} numbers for each voxel; one is needed")
    if not of_points:
        nx, ny, nz = max(nx - 1, 1), max(ny - 1, 1), max(nz - 1, 1)
    axes = np.asarray(getattr(image, "direction_matrix", np.eye(3)), np.float64)
    matrix = np.empty((3, 4))
    matrix[:, :3] = axes * np.asarray(image.spacing, np.float64)
    matrix[:, 3] = np.asarray(image.origin, np.float64)
    if not of_points:
        matrix[:, 3] += 0.5 * matrix[:, :3].sum(axis=1)
    return Volume(values.reshape(nz, ny, nx), index_to_world=matrix, context=context)


_PACKAGES: dict[str, Callable[[Any, Any], list[_Part]]] = {
    "laspy": _of_laspy, "open3d": _of_open3d, "trimesh": _of_trimesh, "pyvista": _of_pyvista, "pandas": _of_table,
    "polars": _of_table}

adapters.append(as_drawables)
