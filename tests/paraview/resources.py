# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""resources.py PLUGIN_FOLDER XML: the icon that the plugin's XML names is one of ParaView's or in the plugin's Qt resources, whose
files are there. For builds with and without Qt's development files."""

import pathlib
import sys
import xml.etree.ElementTree as tree

folder = pathlib.Path(sys.argv[1])
own = set()
for resources in tree.parse(folder / "isotet.qrc").iter("qresource"):
    for file in resources.iter("file"):
        assert tree.parse(folder / file.text).getroot().tag == "{http://www.w3.org/2000/svg}svg"
        own.add(f":{resources.get('prefix')}/{file.text}")
icons = {hint.get("icon") for hint in tree.parse(sys.argv[2]).iter("ShowInMenu")}
assert icons and own, (icons, own)
assert icons <= own | {":/pqWidgets/Icons/pqIsosurface.svg"}, icons
assert own <= {word.strip('"()') for word in (folder / "CMakeLists.txt").read_text().replace("(", " ").split()}, own
print("ok")
