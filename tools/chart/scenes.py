# SPDX-License-Identifier: Apache-2.0
"""How far the force of each shipped scene's tool is off at its largest local error, under each law, and by which reference.

It is finite strain where finite_strain.json has the scene and law, else the linear reference of the whole
tool: of SCENE.accuracy for every law, of scenes.json for the law that a scene ships. The picture and the documents read it here.
"""
import collections
import tomllib

FINITE, LINEAR = "finite strain", "linear"
LIGHT_TOUCH_M = 0.001  # shallower presses are solved, and not evaluated
FINITE_SCENE = "liver"  # the one that finite_strain.json presses
FINITE_LAWS = {"rhombus": "shipped", "compliance": "exact"}  # its names of the laws, as the scene has them
Error = collections.namedtuple("Error", "percent reference")
Shipped = collections.namedtuple("Shipped", "law median_us error")


def finite_error(law, strain):
    """The largest of all places and depths; None where that law was not solved for."""
    found = [percent for place in strain.get(FINITE_LAWS.get(law), {}).values() for percent in place.values()]
    return Error(max(found, key=abs), FINITE) if found else None


def linear_error(table):
    pairs = zip(table["depth_m"], table["own_worst_ratio"])
    return Error(100 * max((own for depth, own in pairs if depth > 0.99 * LIGHT_TOUCH_M), key=abs), LINEAR)


def errors_of(folder, finite):
    """{scene: {law: Error}} of each SCENE.accuracy of a folder. `finite`: the values of finite_strain.json."""
    out = {}
    for path in sorted(folder.glob("*.accuracy")):
        laws = {law: linear_error(table) for law, table in tomllib.loads(path.read_text()).items() if isinstance(table, dict)}
        strain = finite.get("strain", {}) if path.stem == FINITE_SCENE else {}
        out[path.stem] = {law: finite_error(law, strain) or error for law, error in laws.items()}
    return out


def shipped_of(scenes, finite):
    """{scene: Shipped}, of the values of scenes.json."""
    def error(name, value):
        strain = finite.get("strain", {}) if name == FINITE_SCENE else {}
        return finite_error(value["law"], strain) or Error(value["own_percent"], LINEAR)
    return {name: Shipped(value["law"], value["median_us"], error(name, value)) for name, value in scenes.items()}
