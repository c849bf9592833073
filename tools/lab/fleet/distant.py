"""Files from and to wherever fsspec knows the way."""
import os
import pathlib
import uuid


def is_local(path):
    return "://" not in path


def lacking(path):
    """What this machine lacks to reach it, in words, or None."""
    from fsspec import get_filesystem_class
    try:
        get_filesystem_class(path.partition("://")[0])
    except (ImportError, ValueError) as error:
        return str(error)
    return None


def absolute(path):
    """As workers understand it, whatever folder they were started in."""
    return str(pathlib.Path(path).absolute()) if is_local(path) else path


def fetched(path, folder):
    """The file where a program can read it; a copy is of the date of the original, or, where that is not known, of 1970."""
    if is_local(path):
        pathlib.Path(path).stat()
        return pathlib.Path(path)
    from fsspec.core import url_to_fs
    files, inner = url_to_fs(path)
    local = pathlib.Path(folder) / pathlib.PurePosixPath(path).name
    files.get_file(inner, str(local))
    try:
        date_s = files.modified(inner).timestamp()
    except NotImplementedError:
        date_s = 0
    os.utime(local, (date_s, date_s))
    return local


def is_there(path):
    from fsspec.core import url_to_fs
    files, inner = url_to_fs(path)
    return files.exists(inner)


def stored(local, path):
    """Puts the file there, whole or not at all, whoever else does the same."""
    from fsspec.core import url_to_fs
    files, inner = url_to_fs(path)
    beside = f"{inner}.{uuid.uuid4().hex}"
    files.makedirs(inner.rpartition("/")[0], exist_ok=True)
    files.put_file(str(local), beside)
    files.mv(beside, inner)


def removed(folder):
    """With all that is in it."""
    from fsspec.core import url_to_fs
    files, inner = url_to_fs(folder)
    if files.exists(inner):
        files.rm(inner, recursive=True)


def words_of(error):
    """What the system says, without the path."""
    return getattr(error, "strerror", None) or str(error)
