"""BUFR by ecCodes' Python interface alone: what thin's own decoder and its outputs are compared with."""

import eccodes
import numpy as np

MISSING = eccodes.CODES_MISSING_DOUBLE


def messages(path):
    """Every message of a file, unpacked."""
    with open(path, "rb") as file:
        while (message := eccodes.codes_bufr_new_from_file(file)) is not None:
            try:
                eccodes.codes_set(message, "unpack", 1)
                yield message
            finally:
                eccodes.codes_release(message)


def per_subset(message, key):
    """One value per subset, whether the message holds one for all or one each."""
    return np.broadcast_to(eccodes.codes_get_array(message, key), eccodes.codes_get(message, "numberOfSubsets"))


def summary(path):
    """What `thin info --json` says, found out apart from it."""
    times, latitudes, satellites, count = [], [], {}, 0
    ranges = {channel: [] for channel in range(1, 16)}
    message_count = 0
    for message in messages(path):
        message_count += 1
        subsets = eccodes.codes_get(message, "numberOfSubsets")
        count += subsets
        parts = [per_subset(message, key) for key in ("year", "month", "day", "hour", "minute", "second")]
        for year, month, day, hour, minute, second in zip(*parts):
            date = np.datetime64(f"{int(year):04}-{int(month):02}-{int(day):02}", "ms")
            times.append(date + np.timedelta64(round(((hour * 60 + minute) * 60 + second) * 1000), "ms"))
        latitudes.extend(per_subset(message, "latitude"))
        for satellite in per_subset(message, "satelliteIdentifier"):
            satellites[int(satellite)] = satellites.get(int(satellite), 0) + 1
        for rank in range(1, 16):
            channels = per_subset(message, f"#{rank}#tovsOrAtovsOrAvhrrInstrumentationChannelNumber")
            values = per_subset(message, f"#{rank}#brightnessTemperature")
            for channel, value in zip(channels, values):
                if 28 <= channel <= 42 and value != MISSING and value > 0:
                    ranges[int(channel) - 27].append(value)
    return {
        "messages": message_count,
        "observations": count,
        "satellites": satellites,
        "first": min(times),
        "last": max(times),
        "south": min(latitudes),
        "north": max(latitudes),
        "channels": {c: (len(v), min(v, default=None), max(v, default=None)) for c, v in ranges.items()},
    }


def data_keys(message):
    iterator = eccodes.codes_bufr_keys_iterator_new(message)
    keys = []
    while eccodes.codes_bufr_keys_iterator_next(iterator):
        keys.append(eccodes.codes_bufr_keys_iterator_get_name(iterator))
    eccodes.codes_bufr_keys_iterator_delete(iterator)
    return keys


# They say how many subsets there are, so they must change with the selection.
COUNTS = {"numberOfSubsets", "localNumberOfObservations", "subsetNumber", "totalLength"}


def rows(message):
    """One tuple per subset with the values of all keys, as comparable text."""
    subsets = eccodes.codes_get(message, "numberOfSubsets")
    columns = []
    for key in data_keys(message):
        if key in COUNTS:
            continue
        try:
            values = eccodes.codes_get_array(message, key)
        except eccodes.CodesInternalError:
            values = [eccodes.codes_get(message, key)]
        if len(values) == subsets and subsets > 1:
            columns.append([f"{key}={value!r}" for value in values])
        else:
            columns.append([f"{key}={values[0]!r}" if len(values) == 1 else f"{key}={list(values)!r}"] * subsets)
    return list(zip(*columns))
