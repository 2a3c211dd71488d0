// Every wrong machine file gets one sentence: where, what value, which rule, the nearest right word. Here of
// materials, contacts, walls, gravity and domain.
#include "solver/dem/material.hpp"
#include "sweep/campaign/input_error.hpp"
#include "tests/support/wrong_machines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainsweep::tests::machine_errors_bodies_test {

constexpr WrongMachine wrong[] = {
    {"/gravity", "9.81", "$.gravity: ", "must be a list of three numbers: x, y, z."},
    {"/gravity", "[0, 0]", "$.gravity: ", "must be a list of three numbers: x, y, z."},
    {"/gravity", R"([0, 0, "9.81 m"])", "$.gravity[2]: ", "'m' does not fit 'm/s2', these fit: m/s2, mm/s2."},
    {"/gravity", R"({"size": 9.81, "tilt": "10 mm"})",
     "$.gravity.tilt: ", "'mm' does not fit 'rad', these fit: deg, rad."},
    {"/gravity", R"({"tilt": 0.1})", "$.gravity: ", "key 'size' is missing: m/s2."},
    {"/gravity", R"({"size": -1})", "$.gravity.size: ", "must be a number from 0 to 1000000, m/s2."},
    {"/gravity", "[0, 0, 0]", "$.phases[0].until.at_rest: ", "without gravity nothing comes to rest."},
    {"/domain", R"({"low": [0, 0, 0], "high": [1, 1, 0]})", "$.domain: ", R"("low" must lie below "high" along z.)"},
    {"/domain", R"({"sides": ["periodic", "open", "open"]})",
     "$.domain: ", R"(a domain that is periodic along x needs its "low" and "high" there.)"},
    {"/domain", R"({"sides": ["periodic", "open"]})", "$.domain.sides: ", "must be a list of three words: of x, y, z."},
    {"/domain", R"({"sides": ["periodc", "open", "open"]})",
     "$.domain.sides[0]: ", "must be 'open' or 'periodic'. Did you mean 'periodic'?"},
    {"/domain", R"({"periodic": [1, 0]})", "$.domain.periodic: ", "must be a list of three numbers: x, y, z."},
    {"/domain", R"({"periodic": [1, 0, 0], "sides": ["open", "open", "open"]})",
     "$.domain.sides: ", R"(beside "periodic" it says too much.)"},
    {"/domain", R"({"sides": "open"})", "$.domain.sides: ", "must be a list of three words: of x, y, z."},
    {"/domain", R"({"lower": [0, 0, 0]})", "$.domain.lower: unknown key", "unknown key"},
    {"/domain", R"({"low": [0, 0]})", "$.domain.low: ", "must be a list of three numbers: x, y, z."},
    {"/domain", R"({"low": [0.001, 0.001, 0.001], "high": [0.01, 0.01, 0.01]})", "",
     "heavy and light: the region of the filling lies outside of the domain along z"},
    {"/domain", R"({"low": [0, null, null], "high": [0.015, null, null], "sides": ["periodic", "open", "open"]})",
     "$: ", "wall 'box': a wall must not be longer than the period along x"},
    {"/domain", R"({"low": [0, null, null], "high": [0.02, null, null], "sides": ["periodic", "open", "open"]})",
     "$: ", "wall 'paddle': a wall that turns about an axis across the periodic axis x has no image"},
    {"/materials", "REMOVE", "$: ", "key 'materials' is missing: by name: density and stiffness."},
    {"/materials", "{}", "$.materials: ", "must be an object of materials by name."},
    {"/materials", "[]", "$.materials: ", "must be an object of materials by name."},
    {"/materials/glass/density", "REMOVE",
     "$.materials.glass: ", "key 'density' is missing: particles of 'light' are of it."},
    {"/materials/glass/density", "0", "$.materials.glass.density: ", "must be a number above 0, kg/m3."},
    {"/materials/glass/density", "-2500", "$.materials.glass.density: ", "must be a number above 0, kg/m3."},
    {"/materials/glass/density", R"("2500 kg")",
     "$.materials.glass.density: ", "'kg' does not fit 'kg/m3', these fit: kg/m3, g/cm3."},
    {"/materials/glass/density", R"("2.5 g/cm")",
     "$.materials.glass.density: ", "'g/cm' does not fit 'kg/m3', the nearest that fits is 'g/cm3'."},
    {"/materials/glass/youngs_modulus", "REMOVE", "$.materials.glass: ", "key 'youngs_modulus' is missing: Pa."},
    {"/materials/glass/youngs_modulus", "5",
     "$.materials.glass.youngs_modulus: ", "must be a number from 1000 to 10000000000000, Pa."},
    {"/materials/glass/youngs_modulus", R"("60 um")",
     "$.materials.glass.youngs_modulus: ", "'um' does not fit 'Pa', these fit: Pa, kPa, MPa, GPa."},
    {"/materials/glass/poisson_ratio", "0.6", "$.materials.glass.poisson_ratio: ", "must be a number from 0 to 0.5."},
    {"/materials/glass/poisson", "0.3", "$.materials.glass.poisson: unknown key", "Did you mean 'poisson_ratio'?"},
    {"/materials/glass/restitution", "0.3", "$.materials.glass.restitution: unknown key", "unknown key"},
    {"/materials/glass", "5", "$.materials.glass: ", "must be an object."},
    {"/materials/notes", R"({"youngs_modulus": 1e6})",
     "$.materials.notes: ", "here are names, and 'notes' is none: put notes into the object around it."},
    {"/contacts/restitution", "0", "$.contacts.restitution: ", "must be a number above 0 and up to 1."},
    {"/contacts/restitution", "1.5", "$.contacts.restitution: ", "must be a number above 0 and up to 1."},
    {"/contacts/friction", R"("frictoin")",
     "$.contacts.friction: ", "'frictoin' is no name here (the nearest is 'friction'), at position 1."},
    {"/contacts/friction", "-1", "$.contacts.friction: ", "must be a number from 0 to 10."},
    {"/contacts/rolling_law", R"("espd")", "$.contacts.rolling_law: ", "Did you mean 'epsd'?"},
    {"/contacts/rolling_law", "2", "$.contacts.rolling_law: ", "must be 'epsd', 'epsd_liggghts'"},
    {"/contacts/tangential_limit", R"("springs")",
     "$.contacts.tangential_limit: ", "must be 'sum' or 'spring'. Did you mean 'spring'?"},
    {"/contacts/cohesion_law", R"("JKR")", "$.contacts.cohesion_law: ", "Did you mean 'jkr'?"},
    {"/contacts/cohesion_law", "2", "$.contacts.cohesion_law: ", "must be 'sjkr', 'sjkr2', 'paper', 'jkr', 'dmt'"},
    {"/contacts/pairs/glass wood", R"({"friction": 0.1})", R"($.contacts.pairs["glass wood"]: )",
     "a pair is named by two materials with a blank between them."},
    {"/contacts/pairs/glass-steel", R"({"friction": 0.1})", "$.contacts.pairs.glass-steel: ",
     "a pair is named by two materials with a blank between them. Did you mean 'glass steel'?"},
    {"/contacts/pairs/steel glass", R"({"friction": 0.1})", R"($.contacts.pairs["steel glass"]: )",
     "this pair is there twice."},
    {"/contacts/pairs/glass glass", R"({"rolling_law": "cdt"})",
     R"($.contacts.pairs["glass glass"].rolling_law: unknown key)", "unknown key"},
    {"/contacts/pairs", R"(["glass steel"])", "$.contacts.pairs: ", R"(must be an object of pairs: "glass steel".)"},
    {"/contacts/frictoin", "0.1", "$.contacts.frictoin: unknown key", "Did you mean 'friction'?"},
    {"/contacts/surface_tension", "\"72 mN/m\"",
     "$.contacts.surface_tension: ", "0.072 has no effect: it belongs to \"cohesion_law\" 'capillary'"},
    {"/contacts/surface_energy", "\"10 J/m2\"",
     "$.contacts.surface_energy: ", "that is 'sjkr' here, which uses \"cohesion\"."},
    {"PATCH",
     R"([{"op":"add","path":"/contacts/cohesion_law","value":"jkr"},{"op":"add","path":"/contacts/cohesion","value":1e6}])",
     "$.contacts.cohesion: ", "is 'jkr' here, which uses \"surface_energy\"."},
    {"PATCH",
     R"([{"op":"add","path":"/contacts/cohesion_law","value":"capillary"},{"op":"add","path":"/contacts/surface_energy","value":1}])",
     "$.contacts.surface_energy: ", "is 'capillary' here, which uses \"surface_tension\"."},
    {"/contacts/pairs/glass steel", R"({"surface_energy": 0.1})", R"($.contacts.pairs["glass steel"].surface_energy: )",
     "0.1 has no effect: it belongs to \"cohesion_law\" 'jkr'"},
    {"/contacts/surface_energy", "-1", "$.contacts.surface_energy: ", "must be a number from 0 to 100, J/m2."},
    {"PATCH",
     R"([{"op":"add","path":"/contacts/cohesion_law","value":"jkr"},{"op":"add","path":"/contacts/pairs/glass steel","value":{"surface_energy":0.1}}])",
     "", "jkr needs surface energy in all contacts or in none: a small one, or dmt, where there is none"},
    {"/walls/box/box", "REMOVE",
     "$.walls.box: ", "a wall has one shape: 'stl', 'triangles', 'plane', 'rectangle', 'perforated', 'disc', 'box',"},
    {"/walls/box/box/high", "[0, 0.02, 0.04]",
     "$.walls.box.box: ", R"("low" of a box must lie below "high" along every axis.)"},
    {"/walls/box/box/open", R"(["z"])",
     "$.walls.box.box.open[0]: ", "must be '-x', '+x', '-y', '+y', '-z' or '+z'. Did you mean '-z'?"},
    {"/walls/box/box/open", R"("+z")", "$.walls.box.box.open: ", "must be a list."},
    {"/walls/box/box/lid", "true", "$.walls.box.box.lid: unknown key", "unknown key"},
    {"/walls/box/material", R"("stel")", "$.walls.box.material: ", "must be 'glass' or 'steel'. Did you mean 'steel'?"},
    {"/walls/box/material", "REMOVE", "$.walls.box: ", "key 'material' is missing: several materials could be meant."},
    {"/walls/box/plane", R"({"normal": [0, 0, 1]})",
     "$.walls.box: ", "a wall has one shape: 'stl', 'triangles', 'plane', 'rectangle', 'perforated', 'disc', 'box',"},
    {"/walls/box/scale", "2", "$.walls.box.scale: ", "only an stl file has a scale."},
    {"/walls/box/facet_angle", "0.1",
     "$.walls.box.facet_angle: ", "only stl and triangles have facets of a curved surface."},
    {"/walls/box/turned", R"({"angle": 1})", "$.walls.box.turned: ", "key 'axis' is missing: direction."},
    {"/walls/lid/at", "[0, 0, 1]", "$.walls.lid.at: ",
     "only stl, triangles, rectangle, perforated, disc and box are placed; other shapes say where they are."},
    {"/walls/lid/plane", R"({"normal": [0, 0, 0]})", "$.walls.lid.plane.normal: ", "a direction must not be 0."},
    {"/walls/lid/plane", R"({"normla": [0, 0, 1]})", "$.walls.lid.plane.normla: unknown key", "Did you mean 'normal'?"},
    {"/walls/lid/plane", "{}",
     "$.walls.lid.plane: ", "key 'normal' is missing: direction, to the side of the particles."},
    {"/walls/lid/during", R"(["fal"])",
     "$.walls.lid.during[0]: ", "must be 'fall', 'turn' or 'stop'. Did you mean 'fall'?"},
    {"/walls/lid/during", "[]", "$.walls.lid.during: ", "must name a phase or several."},
    {"/walls/lid/during", R"(["fall", "fall"])", "$.walls.lid.during[1]: ", "it is there twice."},
    {"/walls/lid/during", "3", "$.walls.lid.during: ", "must be 'fall', 'turn' or 'stop'."},
    {"/walls/lid/when", R"("x")", "$.walls.lid.when: ", "'x' is no name here at position 1."},
    {"/walls/lid/repeat", "2.5e6", "$.walls.lid.repeat: ", "must be a number from 0 to 1000."},
    {"/walls/lid/as", R"("n")", "$.walls.lid.as: ", R"(without "repeat" it has no effect.)"},
    {"/walls/paddle/as", R"("friction")", "$.walls.paddle.as: ", R"(a parameter or "let" has this name.)"},
    {"/walls/paddle/as", R"("pi")", "$.walls.paddle.as: ", R"(a parameter or "let" has this name.)"},
    {"/walls/paddle/repeat", "-1", "$.walls.paddle.repeat: ", "must be a number from 0 to 1000."},
    {"/walls/paddle/rectangle/along", "[0, 0, 0]", "$.walls.paddle.rectangle: ", "its triangles have no area."},
    {"/walls/paddle/motion", R"({"rotate": {"axis": [0, 0, 1], "speed": 1}})",
     "$.walls.paddle.motion: ", "must be a list."},
    {"/walls/paddle/motion/0/from", R"("trun")",
     "$.walls.paddle.motion[0].from: ", "must be a time or a phase: 'fall', 'turn' or 'stop'. Did you mean 'turn'?"},
    {"/walls/paddle/motion/0/as", R"("n")", "$.walls.paddle.motion[0].as: ", R"(without "repeat" it has no effect.)"},
    {"/walls/paddle/motion/0/from", "-1", "$.walls.paddle.motion[0].from: ", "must be a number from 0, s."},
    {"/walls/paddle/motion/0/to", R"("fall")",
     "$.walls.paddle.motion[0]: ", R"(the phase of "to" comes before that of "from".)"},
    {"/walls/paddle/motion/0/to", "0.01",
     "$.walls.paddle.motion[0]: ", R"("from" and "to" of a motion are both phases or both times.)"},
    {"/walls/paddle/motion/0/during", R"("turn")",
     "$.walls.paddle.motion[0].during: ", R"(beside "from" or "to" it says too much.)"},
    {"/walls/paddle/motion/0", R"({"press": {"along": [0, 0, 1], "mass": 1, "speed_at_most": 1}})",
     "$.walls.paddle.motion[0].press: ", R"(it has either a "force", or "times" and "forces".)"},
    {"/walls/paddle/motion/0",
     R"({"press": {"along": [0, 0, 1], "mass": 1, "speed_at_most": 1, "forces": [1, 2], "times": [0]}})",
     "$.walls.paddle.motion[0].press.forces: ", R"(must have two or more values, as many as "times": 1.)"},
    {"/walls/paddle/motion/0",
     R"({"press": {"along": [0, 0, 1], "mass": 1, "speed_at_most": 1, "forces": [1, 2], "times": [1, 1]}})",
     "$.walls.paddle.motion[0].press.times[1]: ", "times must rise."},
    {"/walls/paddle/motion/0",
     R"({"press": {"along": [0, 0, 1], "mass": 1, "speed_at_most": 1, "force": "2*t", "every": 0.1}})",
     "$.walls.paddle.motion[0].press: ", "key 'until' is missing."},
    {"/walls/paddle/motion/0", R"({"press": {"along": [0, 0, 1], "mass": 1, "speed_at_most": 1, "force": "2*t"}})",
     "$.walls.paddle.motion[0].press.force: ", R"(an expression of the time t needs "every" and "until" beside it.)"},
    {"/walls/paddle/motion/0",
     R"({"drive": {"axis": [0, 0, 1], "inertia": 1, "speed_at_most": 1, "torque": "-0.02*t"}})",
     "$.walls.paddle.motion[0].drive.torque: ", R"(an expression of the time t needs "every" and "until" beside it.)"},
    {"/walls/paddle/motion/0",
     R"({"drive": {"axis": [0, 0, 1], "inertia": 1, "speed_at_most": 1, "torque": "-0.02*tt"}})",
     "$.walls.paddle.motion[0].drive.torque: ", "'tt' is no name here"},
    {"/walls/paddle/motion/0", R"({"follow": {"times": [0, 1], "positions": [[0, 0, 0], [0, 0, 1]]}, "from": "turn"})",
     "$.walls.paddle.motion[0].from: ", R"(of "follow" it is a time, s, not a phase.)"},
    {"/walls/paddle/motion/0",
     R"({"drive": {"axis": [0, 0, 1], "inertia": 1, "speed_at_most": 1, "torque": 1, "times": [0, 1]}})",
     "$.walls.paddle.motion[0].drive.times: ", R"(it belongs to "torques".)"},
    {"/walls/paddle/motion/0",
     R"({"drive": {"axis": [0, 0, 1], "inertia": 1, "speed_at_most": 1, "torques": [0, 1], "times": [0, 1], "every": 1}})",
     "$.walls.paddle.motion[0].drive.every: ", R"(it belongs to an expression of t: "torque".)"},
    {"/walls/lid/only", R"("lihgt")", "$.walls.lid.only: ", "must be 'heavy' or 'light'. Did you mean 'light'?"},
    {"/walls/lid/only", "[]", "$.walls.lid.only: ", "must name a species or several."},
    {"/walls/lid/only", R"(["light", "light"])", "$.walls.lid.only[1]: ", "it is there twice."},
    {"/walls/paddle/motion/0/rotate/axis", "[0, 0, 0]",
     "$.walls.paddle.motion[0].rotate.axis: ", "a direction must not be 0."},
    {"/walls/paddle/motion/0/rotate/speed", R"("20 mm/s")",
     "$.walls.paddle.motion[0].rotate.speed: ", "'mm/s' does not fit 'rad/s', these fit: rpm, rad/s, deg/s."},
    {"/walls/paddle/motion/0/rotate/speed", "REMOVE",
     "$.walls.paddle.motion[0].rotate: ", "key 'speed' is missing: right hand, rad/s."},
    {"/walls/paddle/motion/0/shift", R"({"velocity": [1, 0, 0]})", "$.walls.paddle.motion[0]: ",
     R"(a motion is one of "rotate", "shift", "convey", "vibrate", "press", "drive" and "free".)"},
    {"/walls/paddle/motion/0", R"({"spin": 3})", "$.walls.paddle.motion[0].spin: unknown key", "unknown key"},
    {"/walls/paddle/motion/0", R"({"vibrate": {"amplitude": [0, 0, 0.001], "frequency": -1}})",
     "$.walls.paddle.motion[0].vibrate.frequency: ", "must be a number from 0, Hz."},
    {"/walls/paddle/motion/0", R"({"shift": {"velocity": [0,0,1]}, "from": 2, "to": 1})",
     "$.walls.paddle.motion[0]: ", "a motion must start at a finite time and not end before it."},
    {"/walls/new", R"({"cylinder": {"radius": -1}, "material": "steel"})",
     "$.walls.new.cylinder: ", "the radius of a cylinder must be positive."},
    {"/walls/new", R"({"cylinder": {"radius": 1, "side": "in"}, "material": "steel"})",
     "$.walls.new.cylinder.side: ", "must be 'inside' or 'outside'."},
    {"/walls/new",
     R"({"cone": {"base": [0,0,0], "base_radius": 1, "end_radius": -1, "length": 1}, "material": "steel"})",
     "$.walls.new.cone: ", "the radii of a cone must not be negative, and one of them positive."},
    {"/walls/new", R"({"tube": {"base": [0,0,0], "inner": 2, "outer": 1, "length": 1}, "material": "steel"})",
     "$.walls.new.tube: ", "the inner radius of a tube must be positive, and the outer one larger."},
    {"/walls/new", R"({"disc": {"radius": 1, "inner": 1}, "material": "steel"})",
     "$.walls.new.disc: ", "the inner radius of a disc must be less than its radius."},
    {"/walls/new", R"({"disc": {"radius": 0}, "material": "steel"})",
     "$.walls.new.disc.radius: ", "must be a number above 0, m."},
    {"/walls/new", R"({"sphere": {"radius": 1}, "material": "steel"})", "$.walls.new.sphere: unknown key",
     "unknown key"},
    {"/walls/new", R"({"triangles": [], "material": "steel"})", "$.walls.new.triangles: ", "it has no triangle."},
    {"/walls/new", R"({"triangles": [[[0,0,0],[1,0,0]]], "material": "steel"})",
     "$.walls.new.triangles[0]: ", "a triangle has three corners."},
    {"/walls/new", R"({"triangles": [[[0,0,0],[1,0,0],[2,0,0]]], "material": "steel"})",
     "$.walls.new.triangles: ", "its triangles have no area."},
    {"/walls/new", R"({"stl": "none.stl", "material": "steel"})", "$.walls.new.stl: ", "there is no file none.stl."},
    {"/walls/new", R"({"stl": "bad.stl", "material": "steel"})",
     "$.walls.new.stl: ", "STL: it is neither text that begins with 'solid' nor has it the 84 bytes before the first"},
    {"/walls/new", R"({"stl": "part_{knd}.stl", "material": "steel"})",
     "$.walls.new.stl: ", "'{knd}' names no parameter that is a word. Did you mean 'kind'?"},
    {"/walls/new", R"({"stl": "part_{kind.stl", "material": "steel"})",
     "$.walls.new.stl: ", "there is no file part_{kind.stl."},
    {"/walls/new", R"({"stl": "bad.stl", "scale": 0, "material": "steel"})",
     "$.walls.new.scale: ", "must be a number above 0, m."},
    {"/walls/new", R"({"stl": 3, "material": "steel"})", "$.walls.new.stl: ", "must be a non-empty text."},
    {"/walls/new wall", R"({"plane": {"normal": [0,0,1]}, "material": "steel"})", R"($.walls["new wall"]: )",
     "a name is letters, digits and _, not a digit first, at most 64."},
    {"/walls/notes", R"({"plane": {"normal": [0,0,1]}, "material": "steel"})",
     "$.walls.notes: ", "here are names, and 'notes' is none: put notes into the object around it."},
    {"/walls", "[]", "$.walls: ", "must be an object of walls by name."},
    {"PATCH",
     R"([{"op":"add","path":"/domain","value":{"low":[-1,-1,-1],"high":[1,1,1]}},{"op":"add","path":"/fill/1","value":{"species":"light","spheres":[{"at":[5,5,5]}]}}])",
     "", "light: a sphere at (5, 5, 5) m lies outside of the domain"},
    {"PATCH",
     R"([{"op":"add","path":"/domain","value":{"low":[-0.01,-0.01,-0.01],"high":[0.03,0.03,0.05]}},{"op":"add","path":"/feed/0/through","value":{"box":{"low":[0.05,0.05,0.03],"high":[0.06,0.06,0.04]}}}])",
     "", "feed: a particle of 0.003 m finds no place in its region, even an empty one: it must lie"},
    {"/domain", R"({"low": [0.03, null, null]})", "$.domain: ", R"("low" must lie below "high" along x.)"},
    {"/walls/box/stl", R"("bad.stl")",
     "$.walls.box: ", "a wall has one shape: 'stl', 'triangles', 'plane', 'rectangle', 'perforated', 'disc', 'box',"},
    {"/walls/lid/scale", "1", "$.walls.lid.scale: ", "only an stl file has a scale."},
    {"/contacts/pairs/glass steel", "0.3", R"($.contacts.pairs["glass steel"]: )", "must be an object."},
};

TEST(MachineErrors, OfBodiesHaveOneSentence) {
    for (const WrongMachine& one : wrong) expect_refusal(one);
}

// The mass of such a wall would stay where it is in the frame of the machine.
TEST(MachineErrors, AWallThatForcesMoveIsNotShakenAlongItsWay) {
    nlohmann::json machine = small_machine();
    machine["walls"]["press"] = nlohmann::json::parse(R"({"rectangle": {"corner": [0, 0, 0.03], "along": [0.001, 0, 0],
        "across": [0, 0.001, 0]}, "motion": [{"press": {"along": [0, 0, -1], "force": 1, "mass": 0.01,
        "speed_at_most": 1}}]})");
    machine["walls"]["press"]["material"] = machine["walls"]["box"]["material"];
    EXPECT_EQ(refusal_of(machine), "accepted");
    machine["shaking"] = {{"amplitude", {0, 0, 1e-4}}, {"frequency", 50}};
    EXPECT_NE(refusal_of(machine).find("$.walls.press.motion: a pressed or free wall does not feel \"shaking\""),
              std::string::npos)
        << refusal_of(machine);
    machine["shaking"]["amplitude"] = {1e-4, 0, 0};
    EXPECT_EQ(refusal_of(machine), "accepted") << "across its way";
    machine["shaking"] = {{"amplitude", {0, 0, 1e-4}}, {"frequency", 0}};
    EXPECT_EQ(refusal_of(machine), "accepted") << "still";
}

TEST(MachineErrors, AnAttractionMayBeZeroWhereItsLawIsAbsent) {
    nlohmann::json machine = small_machine();
    machine["parameters"]["energy"] = {{"unit", "J/m2"}, {"default", 0}};
    machine["parameters"]["law"] = {{"words", {"sjkr", "dmt"}}, {"default", "sjkr"}};
    machine["contacts"]["cohesion_law"] = "{law}";
    machine["contacts"]["surface_energy"] = "energy";
    const Inputs some = {{"energy", 0.01}}, dmt = {{"energy", 0.01}, {"law", std::string("dmt")}};
    EXPECT_EQ(refusal_of(machine), "accepted");
    EXPECT_NE(
        refusal_of(machine, some).find("$.contacts.surface_energy: got \"energy\"; 0.01 has no effect: it belongs"),
        std::string::npos)
        << refusal_of(machine, some);
    EXPECT_EQ(refusal_of(machine, dmt), "accepted");
    machine["species"]["heavy"]["material"] = "glass";
    machine["contacts"]["glued"] = {{"surface_energy", 0.1}};
    EXPECT_NE(refusal_of(machine).find("$.contacts.glued.surface_energy: got 0.1; 0.1 has no effect"),
              std::string::npos)
        << refusal_of(machine);
}

// The words are the rows of the laws, so that a further law changes no sentence above.
TEST(MachineErrors, SentencesListEveryWordOfALaw) {
    const auto listed = [](auto words) {
        std::string text;
        for (std::size_t k = 0; k < words.size(); ++k)
            text += (k == 0 ? "'" : k + 1 == words.size() ? " or '" : ", '") + std::string(words[k]) + "'";
        return text;
    };
    for (const Field& law : dem::law_fields()) {
        nlohmann::json machine = small_machine();
        machine["contacts"][law.name] = 2;
        EXPECT_THAT(refusal_of(machine), testing::HasSubstr("must be " + listed(law.words) + ".")) << law.name;
    }
    for (const dem::Attraction& one : dem::attractions()) {
        nlohmann::json machine = small_machine();
        machine["contacts"]["cohesion_law"] = one.key() == "cohesion" ? "jkr" : "sjkr";
        machine["contacts"][one.key()] = 0.1;
        std::vector<std::string_view> words;
        for (const dem::Attraction& other : dem::attractions())
            if (other.key() == one.key()) words.push_back(other.word);
        EXPECT_THAT(refusal_of(machine),
                    testing::HasSubstr("has no effect: it belongs to \"cohesion_law\" " + listed(words) + "; that is "))
            << one.word;
    }
}

// It stays known, so that its database is sound and its results have names; its cases say why they are refused.
TEST(MachineErrors, AStoredMachineIsReadWhereLaterRulesRefuseItsCases) {
    nlohmann::json document = small_machine();
    document["contacts"]["surface_energy"] = 0.1;
    const nlohmann::json stored = {{"machine", document}, {"files", nlohmann::json::object()}};
    const auto machine =
        campaign::machine_in(stored.dump(), [](const std::string&) -> std::string { throw std::logic_error("none"); });
    Inputs defaults;
    for (const auto& parameter : machine->parameters) defaults.emplace(parameter.name, parameter.default_value);
    EXPECT_EQ(campaign::machine_text(*machine), stored.dump());
    EXPECT_THROW((void)campaign::machine_spec(*machine, defaults, {}), campaign::InputError);
}

}  // namespace grainsweep::tests::machine_errors_bodies_test
