"""Coastlines for maps, from the GSHHS shapes on this machine (Debian: cartopy-data); nothing is ever downloaded."""

import functools
import pathlib
import sys

import cartopy
import cartopy.io.shapereader as shapereader
import shapefile


@functools.cache
def coastlines():
    shapefile.VERBOSE = False  # it remarks on rings that do not matter here
    for folder in (cartopy.config["pre_existing_data_dir"], "/usr/share/cartopy/data"):
        path = pathlib.Path(folder or ".") / "shapefiles" / "gshhs" / "c" / "GSHHS_c_L1.shp"
        if path.exists():
            return list(shapereader.Reader(path).geometries())
    print("plots: no GSHHS coastlines on this machine (Debian: cartopy-data); drawing none", file=sys.stderr)
    return []
