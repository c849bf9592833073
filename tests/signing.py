"""Keys as ale-keys writes them, and signatures with them, by libsodium itself."""
import ctypes
import ctypes.util
import struct

_sodium = ctypes.CDLL(ctypes.util.find_library("sodium") or "libsodium.so.23")
_sodium.sodium_init()
SIGNATURE = 64


class Key:
    """A secret key (ed25519) of an operator or a robot, from its file."""

    def __init__(self, path):
        lines = [line for line in path.read_text(encoding="utf-8").splitlines()[1:] if not line.startswith("#")]
        self.name, seed = lines[0].split()
        self.public, self._secret = ctypes.create_string_buffer(32), ctypes.create_string_buffer(64)
        _sodium.crypto_sign_seed_keypair(self.public, self._secret, bytes.fromhex(seed))
        self.number = struct.unpack(">q", self.public.raw[:8])[0]

    def sign(self, data):
        signature = ctypes.create_string_buffer(SIGNATURE)
        _sodium.crypto_sign_detached(signature, None, data, ctypes.c_ulonglong(len(data)), self._secret)
        return signature.raw


def signed(message, key):
    """The bytes of a message that ends with a signature of fixed size (ale.vouched_t)."""
    message.signature = bytes(SIGNATURE)
    data = message.encode()
    return data[:-SIGNATURE] + key.sign(data[:-SIGNATURE])


def digest(data):
    """As vouched_t has it of a pose."""
    out = ctypes.create_string_buffer(32)
    _sodium.crypto_generichash(out, ctypes.c_size_t(32), data, ctypes.c_ulonglong(len(data)), None, ctypes.c_size_t(0))
    return struct.unpack(">q", out.raw[:8])[0]


def tag(data, key):
    """SipHash-2-4 with a key of 16 bytes, as set points for motor controllers have it."""
    out = ctypes.create_string_buffer(8)
    _sodium.crypto_shorthash(out, data, ctypes.c_ulonglong(len(data)), key)
    return out.raw
