"""Surfaces as binary glTF, as small as viser's page takes them.

Positions are whole steps of 1/32767 m (KHR_mesh_quantization), a third of what floats cost on the
wire. The page computes normals itself, from the triangles around each vertex, and shades flat where
a file declares none: so they are declared, and left out.

Reference: Khronos Group, glTF 2.0 specification, and its extension KHR_mesh_quantization.
"""

import json
import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import StudioError
from studio.engine.skeleton import FloatArray

REACH = 1.0  # [m] the largest coordinate that a file can hold
STEPS = 32767  # from 0 to the reach
_GRID = 4  # only every fourth, 0.12 mm apart, is in use: what varies less compresses better
_BYTE, _SHORT, _UNSIGNED_SHORT, _UNSIGNED, _FLOAT = 5121, 5122, 5123, 5125, 5126
_EXTENSION = "KHR_mesh_quantization"


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles with a color at each corner; those that share a vertex are shaded smoothly."""

    vertices: FloatArray  # (V, 3) [m]
    faces: NDArray[np.int64]  # (F, 3)
    colors: NDArray[np.uint8]  # (V, 4) red, green, blue, alpha


def glb(surface: Surface) -> bytes:
    """Return a surface as a file.

    Raises
    ------
    StudioError
        Where it reaches further than 1 m from its origin.
    """
    farthest = float(np.abs(surface.vertices).max(initial=0.0))
    if farthest > REACH:
        raise StudioError(f"a link's surface reaches {farthest:.2f} m; no more than 1 m fits")
    count = len(surface.vertices)
    places = np.zeros((count, 4), "<i2")  # three coordinates, and two bytes that glTF wants
    places[:, :3] = _GRID * np.round(surface.vertices * (STEPS / REACH / _GRID))
    corners = surface.faces.astype("<u2" if count <= 0xFFFF else "<u4")
    index_type = _UNSIGNED_SHORT if count <= 0xFFFF else _UNSIGNED
    bounds = {"min": places[:, :3].min(0).tolist(), "max": places[:, :3].max(0).tolist()}
    vector, color = {"count": count, "type": "VEC3"}, {"count": count, "type": "VEC4"}
    accessors = (
        vector | bounds | {"bufferView": 0, "componentType": _SHORT, "normalized": True},
        vector | {"componentType": _FLOAT},  # the normals, left out
        color | {"bufferView": 1, "componentType": _BYTE, "normalized": True},
        {"count": corners.size, "type": "SCALAR", "bufferView": 2, "componentType": index_type},
    )
    return _file(accessors, (places, surface.colors, corners))


def _file(
    accessors: tuple[dict[str, object], ...], blocks: tuple[NDArray[np.generic], ...]
) -> bytes:
    """Put one mesh of one material into a file: a header, a chunk of JSON and one of numbers."""
    data = [_padded(block.tobytes(), b"\0") for block in blocks]
    starts = np.cumsum([0, *map(len, data)]).tolist()
    views: list[dict[str, object]] = [
        {"buffer": 0, "byteOffset": start, "byteLength": block.nbytes}
        for start, block in zip(starts, blocks, strict=False)
    ]
    views[0]["byteStride"] = 8
    silk = {"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.55}}
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}, "indices": 3}
    description = {
        "asset": {"version": "2.0"},
        "extensionsUsed": [_EXTENSION],
        "extensionsRequired": [_EXTENSION],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive | {"material": 0}]}],
        "materials": [silk],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": starts[-1]}],
    }
    text = _padded(json.dumps(description, separators=(",", ":")).encode(), b" ")
    chunks = (text, b"JSON"), (b"".join(data), b"BIN\0")
    body = b"".join(struct.pack("<I4s", len(chunk), kind) + chunk for chunk, kind in chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def _padded(data: bytes, filling: bytes) -> bytes:
    """Return data filled up to a multiple of four bytes."""
    return data + filling * (-len(data) % 4)
