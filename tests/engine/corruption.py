"""Damage to files: what disks, networks and strangers do to them."""

import numpy as np

_TOKENS = (
    *(b"1e999", b"-1e308", b"NaN", b"null", b"true", b"-0", b"1" * 400, b'""', b'"\\ud800"'),
    *(b"[" * 3000, b'{"a":' * 1500, b"]" * 9, b"\xff\xfe", b"\0", b"\n" * 50, b"9007199254740993"),
)
_SEPARATORS = b' ,;:\t\n[]{}"'


def corrupted(data: bytes, rng: np.random.Generator) -> bytes:
    """Return a file with damage in it, more often once than in up to four places."""
    for _ in range(max(1, int(rng.integers(-2, 5)))):
        damage = _DAMAGES[int(rng.integers(len(_DAMAGES)))]
        data = damage(data, rng) or b"x"
    return data


def _flipped_bits(data: bytes, rng: np.random.Generator) -> bytes:
    bent = bytearray(data)
    for place in rng.integers(len(bent), size=int(rng.integers(1, 9))):
        bent[place] ^= 1 << int(rng.integers(8))
    return bytes(bent)


def _replaced_bytes(data: bytes, rng: np.random.Generator) -> bytes:
    bent = bytearray(data)
    for place in rng.integers(len(bent), size=int(rng.integers(1, 5))):
        bent[place] = int(rng.choice(list(b'0123456789eE-.,;"{}[]\n ')))
    return bytes(bent)


def _cut(data: bytes, rng: np.random.Generator) -> bytes:
    start, end = sorted(rng.integers(len(data) + 1, size=2).tolist())
    return data[:start] + data[end:] if rng.random() < 0.5 else data[:end]


def _doubled(data: bytes, rng: np.random.Generator) -> bytes:
    start, end = sorted(rng.integers(len(data) + 1, size=2).tolist())
    return data[:end] + data[start:end] * int(rng.integers(1, 3)) + data[end:]


def _swapped(data: bytes, rng: np.random.Generator) -> bytes:
    """Swap two tokens: numbers, words, whatever separators enclose."""
    first, second = sorted((_token(data, rng), _token(data, rng)))
    if first[1] > second[0]:
        return data
    (a, b), (c, d) = first, second
    return data[:a] + data[c:d] + data[b:c] + data[a:b] + data[d:]


def _replaced_token(data: bytes, rng: np.random.Generator) -> bytes:
    start, end = _token(data, rng)
    return data[:start] + _TOKENS[int(rng.integers(len(_TOKENS)))] + data[end:]


def _token(data: bytes, rng: np.random.Generator) -> tuple[int, int]:
    place = int(rng.integers(len(data)))
    start, end = place, place
    while start > 0 and place - start < 30 and data[start - 1] not in _SEPARATORS:
        start -= 1
    while end < len(data) and end - place < 30 and data[end] not in _SEPARATORS:
        end += 1
    return start, end


_DAMAGES = (_flipped_bits, _replaced_bytes, _cut, _doubled, _swapped, _replaced_token)
