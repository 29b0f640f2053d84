#!/bin/sh
# Guess: a quantity in an HED annotation has the same size in every version of the schema.
#
# Seen, with hedtools 1.3.0 and the standard schemas that it brings, on Python 3.11: not with the prefixes beyond a thousand. Schemas 8.3.0
# and 8.4.0 give them the factors 10e6, 10e-6 and so on, which are ten times the millions and millionths that are meant: 50 us is
# 0.5 ms, 5 MHz is 50 MHz. In 8.2.0, which writes 10^-6, and in 8.5.0, which writes 1e-6, they are right, and so are kilo and
# milli in all. Nothing warns, and each annotation is valid.
#
# Two data sets with the same annotations differ by a factor of ten if `HEDVersion` in `dataset_description.json` does. Write durations
# in ms or s.
#
# Fails if a schema gives another size.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check hedtools==1.3.0
"$folder/env/bin/python" - <<'PYTHON'
import math

from hed import HedString, load_schema_version
from hed.validator import HedValidator

QUANTITIES = {"(Duration/50 us, (Red))": 50e-6, "(Duration/50 ms, (Red))": 50e-3, "Frequency/5 kHz": 5e3, "Frequency/5 MHz": 5e6}

for version, factor in (("8.2.0", 1), ("8.3.0", 10), ("8.4.0", 10), ("8.5.0", 1)):
    schema = load_schema_version(version)
    for text, meant in QUANTITIES.items():
        annotation = HedString(text, schema)
        assert not HedValidator(schema).validate(annotation, allow_placeholders=False), "CHANGED: not valid"
        (quantity,) = (tag for tag in annotation.get_all_tags() if tag.is_unit_class_tag())
        seen = quantity.value_as_default_unit()
        print(f"{version}: {quantity} is {seen:g} {quantity.default_unit.name}")
        expected = meant if "ms" in text or "kHz" in text else factor * meant
        assert math.isclose(seen, expected), "CHANGED"
PYTHON
