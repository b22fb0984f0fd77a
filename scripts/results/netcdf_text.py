"""netCDF by ncdump alone: what thin's own readers and its outputs are compared with."""

import re
import subprocess


def ncdump(*words):
    done = subprocess.run(["ncdump", *map(str, words)], capture_output=True, text=True, errors="replace", check=False)
    if done.returncode != 0:
        raise ValueError(done.stderr.strip())
    return done.stdout


def header(path):
    """Everything but values, with storage, chunks and compression; without the file's name and what varies by run."""
    lines = ncdump("-hs", path).splitlines()[1:]
    return [line for line in lines if "_NCProperties" not in line and "_SuperblockVersion" not in line]


def dimensions(path):
    found = {}
    for name, length in re.findall(r"^\s*(\S+) = (?:UNLIMITED ; // \()?(\d+)", ncdump("-h", path).split("variables:")[0], re.M):
        found.setdefault(name, int(length))
    return found


LOCATIONS = ("Location", "nlocs", "nobs", "d_hdr", "obs")


def location_dimension(path):
    """Name and length of the dimension that observations are counted by; nothing where there is none."""
    there = dimensions(path)
    return next(((name, there[name]) for name in LOCATIONS if name in there), None)


def values(path):
    """Every variable by its path, with its dimensions and its values as text."""
    text = ncdump("-p", "9,17", path)
    shapes, found, groups = {}, {}, []
    for line in text.splitlines():
        if opened := re.match(r"\s*group: (\S+) \{", line):
            groups.append(opened[1])
        elif re.match(r"\s*\} // group", line):
            groups.pop()
        elif declared := re.match(r"\s*(?:unsigned |u?)?(?:byte|char|short|int|int64|uint64|ushort|uint|ubyte|float|double|string)\s+([^\s(]+)\s*\(([^)]*)\)\s*;", line):
            shapes["/".join([*groups, declared[1]])] = [d.strip() for d in declared[2].split(",")]
    groups, inside, name = [], False, None
    for line in text.splitlines():
        if opened := re.match(r"\s*group: (\S+) \{", line):
            groups.append(opened[1])
            inside = False
        elif re.match(r"\s*\} // group", line):
            groups.pop()
            inside = False
        elif line.strip() == "data:":
            inside = True
        elif inside and name is None and (begun := re.match(r"\s*(\S+) =(.*)$", line)):
            name, parts = "/".join([*groups, begun[1]]), [begun[2]]
        elif inside and name is not None:
            parts.append(line)
        if name is not None and parts[-1].rstrip().endswith(";"):
            joined = " ".join(parts).strip()[:-1]
            found[name] = (shapes.get(name, []), [v.strip() for v in re.findall(r'"(?:[^"\\]|\\.)*"|[^,]+', joined) if v.strip()])
            name = None
    return found


def rows(path):
    """One tuple per location, with the values of all variables over locations as text."""
    dimension = location_dimension(path)
    if not dimension or dimension[1] == 0:
        return []
    columns = []
    for name, (shape, tokens) in sorted(values(path).items()):
        if shape and shape[0] == dimension[0] and len(tokens) % dimension[1] == 0:
            width = len(tokens) // dimension[1]
            columns.append([(name, *tokens[i * width : (i + 1) * width]) for i in range(dimension[1])])
    return list(zip(*columns))
