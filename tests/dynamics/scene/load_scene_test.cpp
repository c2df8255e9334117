// SPDX-License-Identifier: MIT
#include "dynamics/assembly/load_scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <numbers>

#include "dynamics/scene/time_dependence.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

/// One of everything; the tables below spoil a line each.
const std::string kScene = R"(name: rig
constants:
  length: 2 m
  half: length / 2
parameters:
  bob: 3 kg
motors: [psi1]
coordinates: [q1, q2]
constraints:
  q1: psi1 / 4
  q2: 10 cm * sin(q1)
transforms:
  - {from: 0, to: 1, theta: q1 + 5 deg, a: half}
  - {from: 1, to: 2, s: q2, alpha: 90 deg}
bodies:
  - {name: weight, frame: 1, mass: bob, center_of_mass: [0, -1 cm, 0]}
  - name: slider
    frame: 2
    mass: 1 kg
    inertia: {xx: 1 kg m^2, yy: 2 kg m^2, zz: 3 kg m^2}
loads:
  - {frame: 2, point: [0, 0, 1 cm], force: [10 N * sin(t / 1 s), 0, 0], moment: [0, 0, 1 N m]}
  - {coordinate: q2, stiffness: 8 N/mm, rest: 1 cm}
gravity: [0, 0, -9.81 m/s^2]
end_effector: {frame: 2, point: [0, 0, 0], axes: [x, y]}
home: {psi1: 120 deg}
singularities:
  flat: sin(q1)
solids:
  - {frame: 1, shape: box, size: [1 cm, 2 cm, half], at: [0, 0, 5 cm]}
  - {frame: 0, shape: sphere, radius: 4 cm}
  - {frame: 2, shape: cylinder, radius: 6 cm, from: [0, -half, 0]}
)";

Scene loaded(const std::string& text, const std::string& file = "scene.yaml") {
  return load_scene(parse_document(text, file));
}

/// The scene above with `line`, which must occur once, as `other`.
std::string with(const std::string& line, const std::string& other) {
  std::string text = kScene;
  const auto at = text.find(line);
  EXPECT_NE(at, std::string::npos) << line;
  EXPECT_EQ(text.find(line, at + 1), std::string::npos) << line;
  return text.replace(at, line.size(), other);
}

double number(const Formula& formula) {
  EXPECT_TRUE(formula.is_constant());
  return formula.constant();
}

TEST(LoadScene, ReadsEverySection) {
  const Scene scene = loaded(kScene);
  EXPECT_EQ(scene.name, "rig");
  EXPECT_EQ(scene.n(), 1);
  EXPECT_EQ(scene.m(), 2);
  EXPECT_EQ(scene.evaluation_order, (std::vector<int>{0, 1}));
  ASSERT_EQ(scene.parameters.size(), 1U);
  EXPECT_EQ(scene.parameters[0].value, 3);
  EXPECT_EQ(scene.frames, (std::vector<std::string>{"0", "1", "2"}));
  EXPECT_EQ(scene.transforms[0].coordinate, 0);
  EXPECT_FALSE(scene.transforms[0].prismatic);
  EXPECT_EQ(number(scene.transforms[0].a), 1);
  EXPECT_EQ(scene.transforms[1].coordinate, 1);
  EXPECT_TRUE(scene.transforms[1].prismatic);
  EXPECT_EQ(scene.bodies[0].name, "weight");
  EXPECT_FALSE(scene.bodies[0].mass.is_constant());
  EXPECT_EQ(number(scene.bodies[0].center_of_mass[1]), -0.01);
  EXPECT_EQ(number(scene.bodies[0].inertia[2]), 0);
  EXPECT_EQ(number(scene.bodies[1].inertia[2]), 3);
  EXPECT_EQ(scene.loads[0].frame, 2);
  ASSERT_EQ(scene.coordinate_loads.size(), 1U);
  EXPECT_EQ(scene.coordinate_loads[0].coordinate, 1);
  EXPECT_EQ(number(scene.coordinate_loads[0].stiffness), 8000);
  EXPECT_EQ(number(scene.coordinate_loads[0].rest), 0.01);
  EXPECT_EQ(number(scene.coordinate_loads[0].damping), 0);
  EXPECT_EQ(number(scene.gravity[2]), -9.81);
  EXPECT_EQ(scene.end_effector.axes, (std::vector<int>{0, 1}));
  EXPECT_DOUBLE_EQ(scene.home[0], 120 * std::numbers::pi / 180);
  EXPECT_EQ(scene.singularities[0].name, "flat");
  EXPECT_TRUE(scene.warnings.empty());
  using Shape = Scene::Solid::Shape;
  using Triple = std::array<double, 3>;
  ASSERT_EQ(scene.solids.size(), 3U);
  EXPECT_EQ(scene.solids[0].frame, 1);
  EXPECT_EQ(scene.solids[0].shape, Shape::box);
  EXPECT_EQ(scene.solids[0].size, (Triple{0.01, 0.02, 1}));
  EXPECT_EQ(scene.solids[0].from, (Triple{0, 0, 0.05}));
  EXPECT_EQ(scene.solids[0].to, scene.solids[0].from);
  EXPECT_EQ(scene.solids[1].shape, Shape::sphere);
  EXPECT_EQ(scene.solids[1].radius, 0.04);
  EXPECT_EQ(scene.solids[2].shape, Shape::cylinder);
  EXPECT_EQ(scene.solids[2].from, (Triple{0, -1, 0}));
  EXPECT_EQ(scene.solids[2].to, Triple{});
}

TEST(LoadScene, ReadsLoadsAlongFormulasAndBetweenPoints) {
  const std::string spring = "  - {coordinate: q2, stiffness: 8 N/mm, rest: 1 cm}";
  const Scene scene = loaded(with(spring, R"(  - {along: q1 - psi1/2 + t * 1 rad/s, damping: 3 N m s/rad}
  - {between: [{frame: 0, point: [0, half, 0]}, {frame: 2}], stiffness: 8 N/mm, rest: 1 cm})"));
  ASSERT_EQ(scene.along_loads.size(), 1U);
  EXPECT_TRUE(scene.along_loads[0].law.stiffness.is_zero());
  EXPECT_TRUE(scene.along_loads[0].law.rest.is_zero());
  EXPECT_EQ(number(scene.along_loads[0].law.damping), 3);
  ASSERT_EQ(scene.between_loads.size(), 1U);
  EXPECT_EQ(scene.between_loads[0].ends[0].frame, 0);
  EXPECT_EQ(number(scene.between_loads[0].ends[0].point[1]), 1);
  EXPECT_EQ(scene.between_loads[0].ends[1].frame, 2);
  EXPECT_TRUE(scene.between_loads[0].ends[1].point[0].is_zero());
  EXPECT_EQ(number(scene.between_loads[0].law.stiffness), 8000);
  EXPECT_EQ(number(scene.between_loads[0].law.rest), 0.01);
  EXPECT_NE(scene.canonical, loaded(kScene).canonical);
  EXPECT_TRUE(scene.has_friction());
  EXPECT_FALSE(loaded(kScene).has_friction());
}

TEST(LoadScene, AsksLoadsOfEitherKindWhetherItIsLoadedOrDependsOnTime) {
  const auto without_loads = [](const std::string& load) {
    return loaded("motors: [psi]\nloads: [" + load +
                  "]\ntransforms: [{from: 0, to: arm, theta: psi, a: 1}]\nbodies: [{frame: arm, mass: 1}]\n"
                  "end_effector: {frame: arm}\n");
  };
  EXPECT_FALSE(without_loads("").is_loaded());
  const Scene along = without_loads("{along: psi, stiffness: 1}"),
              timed = without_loads("{along: psi - t/1 s, stiffness: 1}"),
              between = without_loads("{between: [{frame: 0}, {frame: arm}], rest: 1, stiffness: 1}");
  for (const Scene* scene : {&along, &timed, &between}) {
    EXPECT_TRUE(scene->is_loaded());
    EXPECT_FALSE(constraints_depend_on_time(*scene));
    EXPECT_EQ(loads_depend_on_time(*scene), scene == &timed);
  }
}

TEST(LoadScene, IsTheSameMechanismWhateverItsSolids) {
  EXPECT_EQ(loaded(with("radius: 4 cm", "radius: 5 cm")).canonical, loaded(kScene).canonical);
}

TEST(LoadScene, MostOfItMayBeLeftOut) {
  const Scene scene = loaded(
      "motors: psi\ncoordinates: q\nconstraints: {q: psi}\ntransforms: [{from: 0, to: arm, theta: q}]\n"
      "bodies: [{frame: arm, mass: 1}]\nend_effector: {frame: arm}\n",
      "folder/pendulum.yaml");
  EXPECT_EQ(scene.name, "pendulum") << "the file's";
  EXPECT_EQ(scene.bodies[0].name, "body 1");
  EXPECT_EQ(scene.home, (std::vector<double>{0}));
  EXPECT_EQ(number(scene.gravity[2]), 0);
  EXPECT_EQ(scene.end_effector.axes, (std::vector<int>{0, 1, 2}));
}

TEST(LoadScene, ConstantsConstraintsAndTransformsMayStandInAnyOrder) {
  EXPECT_EQ(number(loaded(with("  length: 2 m\n  half: length / 2", "  half: length / 2\n  length: 2 m"))
                       .transforms[0]
                       .a),
            1);
  const Scene scene =
      loaded(with("  q1: psi1 / 4\n  q2: 10 cm * sin(q1)", "  q2: 10 cm * sin(q1)\n  q1: psi1 / 4"));
  EXPECT_EQ(scene.evaluation_order, (std::vector<int>{0, 1}));
  const Scene turned = loaded(
      with("  - {from: 0, to: 1, theta: q1 + 5 deg, a: half}\n  - {from: 1, to: 2, s: q2, alpha: 90 deg}",
           "  - {from: 1, to: 2, s: q2, alpha: 90 deg}\n  - {from: 0, to: 1, theta: q1 + 5 deg, a: half}"));
  EXPECT_EQ(turned.frames, (std::vector<std::string>{"0", "1", "2"}));
  EXPECT_EQ(turned.canonical, loaded(kScene).canonical);
}

TEST(LoadScene, LinearMotorsAreDeclared) {
  const Scene scene = loaded(
      "motors: {lift: linear, turn: rotary}\ncoordinates: [z, q]\nconstraints: {z: lift, q: turn / 2}\n"
      "transforms: [{from: 0, to: 1, s: z}, {from: 1, to: 2, theta: q}]\n"
      "bodies: [{frame: 2, mass: 1}]\nend_effector: {frame: 2}\nhome: {lift: 10 cm}\n");
  EXPECT_TRUE(scene.motors()[0].linear);
  EXPECT_FALSE(scene.motors()[1].linear);
  EXPECT_TRUE(scene.transforms[0].prismatic);
  EXPECT_EQ(scene.home, (std::vector<double>{0.1, 0}));
}

TEST(LoadScene, MayNameNoEndEffector) {
  const Scene scene = loaded(with("end_effector: {frame: 2, point: [0, 0, 0], axes: [x, y]}", ""));
  EXPECT_FALSE(scene.end_effector.named);
  EXPECT_EQ(scene.end_effector.frame, 0) << "the ground's origin stands for it";
  EXPECT_TRUE(scene.end_effector.point[2].is_zero());
  EXPECT_NE(scene.canonical, loaded(kScene).canonical);
}

TEST(LoadScene, TheCanonicalTextIsOfTheMechanismNotItsSpelling) {
  const std::string canonical = loaded(kScene).canonical;
  EXPECT_EQ(loaded("# a comment\n" + with("name: rig", "name: other")).canonical, canonical);
  EXPECT_EQ(loaded(with("length: 2 m", "length: 200 cm")).canonical, canonical);
  EXPECT_EQ(loaded(with("name: weight", "name: heavy")).canonical, canonical);
  EXPECT_NE(loaded(with("length: 2 m", "length: 2.1 m")).canonical, canonical);
  EXPECT_NE(loaded(with("axes: [x, y]", "axes: [x, z]")).canonical, canonical);
  EXPECT_EQ(loaded(with("bob: 3 kg", "bob: 4 kg")).canonical, canonical)
      << "a parameter's value is no part of the mechanism";
}

TEST(LoadScene, AnOverrideReachesEveryEntry) {
  NodePtr document = parse_document(kScene, "scene.yaml");
  document = override_entry(document, "constants.length", "4 m");
  document = override_entry(document, "bodies[1].inertia.xx", "1.5 kg m^2");
  const Scene scene = load_scene(document);
  EXPECT_EQ(number(scene.transforms[0].a), 2);
  EXPECT_EQ(number(scene.bodies[1].inertia[0]), 1.5);
  const auto error = input_error([&] { load_scene(override_entry(document, "gravity[2]", "9.81 m/s")); });
  EXPECT_EQ(error->code, "wrong_dimension");
  EXPECT_EQ(to_string(error->place), "--set gravity[2]:1:1");
}

TEST(LoadScene, ThePapersRobotLoads) {
  const Scene scene = load_scene(std::filesystem::path(MIXLOOP_SCENES "/mixed_loop_robot.yaml"));
  EXPECT_EQ(scene.n(), 3);
  EXPECT_EQ(scene.m(), 6);
  EXPECT_TRUE(scene.warnings.empty()) << "Table B-2 just keeps the triangle inequality";
}

TEST(LoadScene, ATriangleInequalityBrokenIsOnlyAWarning) {
  const Scene scene = loaded(with("zz: 3 kg m^2", "zz: 3.5 kg m^2"));
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0],
            "scene.yaml:17:5: the largest moment of inertia of 'slider', 3.5 kg m^2, exceeds the sum of the "
            "others, 3: no real mass is spread so");
}

TEST(LoadScene, AnInertiaMayBeSemidefinite) {
  EXPECT_NO_THROW(loaded(with("inertia: {xx: 1 kg m^2, yy: 2 kg m^2, zz: 3 kg m^2}",
                              "inertia: {xx: 0, yy: 2 kg m^2, zz: 2 kg m^2}")));
  EXPECT_NO_THROW(loaded(with("inertia: {xx: 1 kg m^2, yy: 2 kg m^2, zz: 3 kg m^2}",
                              "inertia: {xx: 0.1, yy: 0.1, zz: 0.2, xy: -0.1}")));
}

TEST(ParameterValues, AreDefaultsUnlessGiven) {
  const Scene scene = loaded(kScene);
  EXPECT_EQ(parameter_values(scene, nullptr, scene.default_parameters()), (std::vector<double>{3}));
  EXPECT_EQ(
      parameter_values(scene, parse_document("{bob: 500 mm * 1 kg / 1 m}", "f"), scene.default_parameters()),
      (std::vector<double>{0.5}));
}

TEST(ParameterValues, AreCheckedAsTheScenes) {
  const Scene scene = loaded(kScene);
  const auto refused = [&](const std::string& text) {
    return *input_error(
        [&] { parameter_values(scene, parse_document(text, "f"), scene.default_parameters()); });
  };
  EXPECT_EQ(refused("{bab: 3 kg}").code, "unknown_key");
  EXPECT_EQ(refused("{bob: 3 m}").code, "wrong_dimension");
  EXPECT_STREQ(refused("{bob: -3 kg}").what(),
               "f:1:1: with these parameters, 'weight' has a mass of -3 kg; expected 0 or more");
}

/// What users are told.
std::string page(const std::string& name) {
  std::ifstream in(MIXLOOP_DOCS "/" + name);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SceneDocumentation, ItsFirstExampleLoads) {
  const std::string text = page("scenes.md");
  const auto begin = text.find('\n', text.find("```yaml")) + 1;
  const Scene scene = loaded(text.substr(begin, text.find("```", begin) - begin), "scenes.md");
  EXPECT_EQ(scene.n(), 1);
  EXPECT_EQ(number(scene.transforms[0].a), 0.3);
}

class RefusedScene : public testing::TestWithParam<BadInput> {};

TEST_P(RefusedScene, WithItsPlace) {
  static const std::string errors = page("errors.md");
  EXPECT_NE(errors.find("| `" + std::string(GetParam().code) + "` |"), std::string::npos)
      << "not in docs/errors.md";
  expect_refused(GetParam(), [](const std::string& text, const std::string& file) { loaded(text, file); });
}

INSTANTIATE_TEST_SUITE_P(
    Keys, RefusedScene,
    testing::Values(
        BadInput{"NoMapping", "@- 1\n", "wrong_kind", "found a list of 1; expected the scene as a mapping"},
        BadInput{"UnknownSection", with("gravity:", "@gravty:"), "unknown_key",
                 "unknown key 'gravty' in the scene; did you mean 'gravity'?"},
        BadInput{"UnknownKeyOfATransform", with("s: q2", "@S1: q2"), "unknown_key", "in a transform"},
        BadInput{"UnknownKeyOfABody", with("center_of_mass", "@centre_of_mass"), "unknown_key",
                 "in a body; did you mean 'center_of_mass'?"},
        BadInput{"UnknownElement", with("yy: 2", "@yx: 2"), "unknown_key", "unknown key 'yx' in an inertia"},
        BadInput{"UnknownKeyOfALoad", with("force:", "@forces:"), "unknown_key", "did you mean 'force'?"},
        BadInput{"UnknownShape", with("shape: sphere", "shape: @spere"), "unknown_value",
                 "the shape of a solid is 'spere'; did you mean 'sphere'?"},
        BadInput{"KeyOfAnotherShape", with("size: [1 cm", "@radius: 1 cm, size: [1 cm"), "unknown_key",
                 "unknown key 'radius' in a box"},
        BadInput{"CylinderWithoutRadius",
                 with("{frame: 2, shape: cylinder, radius: 6 cm,", "@{frame: 2, shape: cylinder,"),
                 "missing_key", "a cylinder lacks the key 'radius'"},
        BadInput{"SphereOfNothing", with("radius: 4 cm", "radius: @0"), "out_of_range",
                 "the radius of a sphere is 0 m; expected more than 0"},
        BadInput{"FlatBox", with("size: [1 cm, 2 cm, half]", "size: @[1 cm, 0, half]"), "out_of_range",
                 "an edge of a box is 0 m"},
        BadInput{"CylinderFromHereToHere",
                 with("{frame: 2, shape: cylinder, radius: 6 cm, from: [0, -half, 0]}",
                      "@{frame: 2, shape: cylinder, radius: 6 cm}"),
                 "out_of_range", "expected 'from' and 'to' that differ"},
        BadInput{"SolidOfAParameter", with("radius: 4 cm", "radius: @1 cm * bob / 1 kg"), "varying_number",
                 "the radius of a sphere depends on no parameter"},
        BadInput{"UnknownMotorAtHome", with("psi1: 120 deg", "@psi2: 120 deg"), "unknown_key",
                 "in home; did you mean 'psi1'?"},
        BadInput{"MissingMotors", "@" + with("motors: [psi1]\n", ""), "missing_key",
                 "neither 'motors' nor 'free'"},
        BadInput{"MissingFrom", with("{from: 1, to: 2", "@{to: 2"), "missing_key",
                 "a transform lacks the key 'from'"},
        BadInput{"MissingTo", with("{from: 1, to: 2", "@{from: 1"), "missing_key",
                 "a transform lacks the key 'to'"},
        BadInput{"MissingMass", with("{name: weight, frame: 1, mass: bob", "@{name: weight, frame: 1"),
                 "missing_key", "a body lacks the key 'mass'"},
        BadInput{"MissingFrame", with("- name: slider\n    frame: 2", "- @name: slider"), "missing_key",
                 "a body lacks the key 'frame'"},
        BadInput{"MissingElement", with("{xx: 1 kg m^2, ", "@{"), "missing_key",
                 "an inertia lacks the key 'xx'"},
        BadInput{"EmptySection", with("motors: [psi1]", "motors: @[]"), "wrong_size",
                 "found a list of 0; expected the motors' names, from 1 to 64"},
        BadInput{"NoCoordinates", with("coordinates: [q1, q2]", "coordinates: @[]"), "wrong_size",
                 "the coordinates' names"},
        BadInput{"ScalarSection", with("constants:\n  length: 2 m\n  half: length / 2", "constants: @2 m"),
                 "wrong_kind", "found '2 m'; expected constants as name: value"},
        BadInput{
            "BodiesAsMapping",
            with("bodies:\n  - {name: weight, frame: 1, mass: bob, center_of_mass: [0, -1 cm, 0]}\n  - name",
                 "bodies:\n    @name"),
            "wrong_kind", "found a mapping; expected a list: the bodies"},
        BadInput{"WordForAVector", with("gravity: [0, 0, -9.81 m/s^2]", "gravity: @9.81 m/s^2"), "wrong_size",
                 "found '9.81 m/s^2'; expected gravity as [x, y, z]"},
        BadInput{"TwoOfAVector", with("[0, 0, -9.81 m/s^2]", "@[0, -9.81 m/s^2]"), "wrong_size",
                 "found a list of 2; expected gravity as [x, y, z]"},
        BadInput{"AxisTwice", with("axes: [x, y]", "axes: [x, @x]"), "doubly_defined",
                 "the axis 'x' is given twice"},
        BadInput{"UnknownAxis", with("axes: [x, y]", "axes: [x, @u]"), "unknown_value", "an axis is 'u'"},
        BadInput{"NoAxis", with("axes: [x, y]", "axes: @[]"), "wrong_size", "axes out of x, y, z"},
        BadInput{"KindOfMotor", with("motors: [psi1]", "motors: {psi1: @linaer}"), "unknown_value",
                 "the motor's kind is 'linaer'; did you mean 'linear'?"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Units, RefusedScene,
    testing::Values(
        BadInput{"UnknownUnit", with("length: 2 m", "length: 2 @feet"), "unknown_unit",
                 "unknown unit 'feet'"},
        BadInput{"UnitOfAVector", with("-9.81 m/s^2", "-9.81 @mps"), "unknown_unit", "did you mean"},
        BadInput{"MassInMetres", with("mass: 1 kg", "mass: @1 m"), "wrong_dimension",
                 "the mass is a length (m); expected a mass (kg)"},
        BadInput{"AngleInMetres", with("theta: q1 + 5 deg", "theta: @length"), "wrong_dimension",
                 "theta is a length (m); expected a number or an angle"},
        BadInput{"LengthInRadians", with("a: half", "a: @30 deg"), "wrong_dimension",
                 "a is a number or an angle; expected a length (m)"},
        BadInput{"GravityWithoutSeconds", with("-9.81 m/s^2", "@-9.81 m"), "wrong_dimension",
                 "gravity is a length (m); expected an acceleration (m/s^2)"},
        BadInput{"InertiaInKilograms", with("zz: 3 kg m^2", "zz: @3 kg"), "wrong_dimension",
                 "I_zz is a mass (kg); expected a moment of inertia (kg m^2)"},
        BadInput{"ForceAsMoment", with("1 N m]", "@1 N]"), "wrong_dimension",
                 "the moment is a force (N); expected a moment (N m)"},
        BadInput{"SumOfALengthAndAnAngle", with("theta: q1 + 5 deg", "theta: q1 @+ 5 cm"), "wrong_dimension",
                 "cannot be added"},
        BadInput{"CoordinateInKilograms", with("psi1 / 4", "@psi1 * 4 kg"), "wrong_dimension",
                 "the coordinate 'q1' is a mass (kg); expected an angle or a length"},
        BadInput{"ParameterAsLength", with("a: half", "a: @bob"), "wrong_dimension", "a is a mass (kg)"},
        BadInput{"HomeInMetres", with("120 deg", "@1 m"), "wrong_dimension",
                 "the position of 'psi1' is a length (m); expected a number or an angle"},
        BadInput{"TimeAsAngle", with("sin(t / 1 s)", "@sin(t)"), "wrong_dimension",
                 "a function of a time (s)"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Symbols, RefusedScene,
    testing::Values(
        BadInput{"UndefinedConstant", with("length / 2", "@lenght / 2"), "undefined_symbol",
                 "undefined symbol 'lenght'; did you mean 'length'?"},
        BadInput{"UndefinedInConstraint", with("psi1 / 4", "@psi2 / 4"), "undefined_symbol",
                 "did you mean 'psi1'?"},
        BadInput{"UndefinedInTransform", with("s: q2", "s: @q3"), "undefined_symbol", "'q3'"},
        BadInput{"CoordinateInAConstant", with("length / 2", "@q1 * 2"), "undefined_symbol", "'q1'"},
        BadInput{"TimeInAMass", with("mass: 1 kg", "mass: 1 kg * @t"), "undefined_symbol", "'t'"},
        BadInput{"ParameterFromAConstant", with("bob: 3 kg", "bob: 3 kg * @half"), "undefined_symbol",
                 "'half'; expected a number"},
        BadInput{"ConstantTwice", with("  half: length", "  @length: 3 m\n  half: length"), "doubly_defined",
                 "'length' is given twice, first at line 3"},
        BadInput{"ConstantAndParameter", with("length: 2 m", "length: 2 m\n  @bob: 1"), "doubly_defined",
                 "'bob' is defined twice, first at line 7"},
        BadInput{"ConstantAndMotor", with("motors: [psi1]", "motors: [psi1, @half]"), "doubly_defined",
                 "'half' is defined twice, first at line 4"},
        BadInput{"MotorTwice", with("motors: [psi1]", "motors: [psi1, @psi1]"), "doubly_defined",
                 "'psi1' is defined twice, first at line 7"},
        BadInput{"MotorAndCoordinate",
                 with("motors: [psi1]", "motors: [psi1, q2]")
                     .replace(with("motors: [psi1]", "motors: [psi1, q2]").find("  q2: 10"), 2, "  @"),
                 "doubly_defined", "'q2' is defined twice"},
        BadInput{"CoordinateTwice", with("[q1, q2]", "[q1, q2, @q1]"), "doubly_defined",
                 "'q1' is listed twice"},
        BadInput{"ConstantNamedAsAUnit", with("length: 2 m", "length: 2 m\n  @m: 2 m"), "invalid_name",
                 "'m' is a unit"},
        BadInput{"ConstantNamedAsAFunction", with("length: 2 m", "length: 2 m\n  @sin: 2 m"), "invalid_name",
                 "'sin' has a meaning"},
        BadInput{"ConstantNamedAsTheTime", with("length: 2 m", "length: 2 m\n  @t: 2 s"), "invalid_name",
                 "'t' is the time"},
        BadInput{"MotorNamedAsTheTime", with("motors: [psi1]", "motors: [psi1, @t]"), "invalid_name",
                 "'t' is the time"},
        BadInput{"NoName", with("coordinates: [q1, q2]", "coordinates: [q1, q2, @q-3]"), "invalid_name",
                 "'q-3' is no name"},
        BadInput{"CyclicConstants", with("length: 2 m", "@length: half * 2"), "cyclic_definition",
                 "constants defined by themselves: length -> half -> length"},
        BadInput{"ConstantOfItself", with("length: 2 m", "@length: length"), "cyclic_definition",
                 "length -> length"},
        BadInput{"CyclicCoordinates",
                 with("psi1 / 4", "psi1 / 4 + q2 / 1 m").replace(kScene.find("  q1: psi1"), 2, "  @"),
                 "cyclic_definition", "q1 -> q2 -> q1"},
        BadInput{"MissingConstraint", with("[q1, q2]", "[q1, q2, @q3]"), "missing_constraint",
                 "no constraint gives the coordinate 'q3'; expected an entry 'q3: ...' under constraints"},
        BadInput{"ConstraintForNoCoordinate", with("  q2: 10", "  @q3: q1\n  q2: 10"), "undefined_symbol",
                 "a constraint for 'q3', which is no coordinate; did you mean 'q1'?"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Frames, RefusedScene,
    testing::Values(
        BadInput{"BodyOnNoFrame", with("frame: 2\n", "frame: @3\n"), "broken_path",
                 "a body sits on the frame '3', which no transform makes; expected one of '0', '1', '2'"},
        BadInput{"LoadOnNoFrame", with("{frame: 2, point: [0, 0, 1 cm]", "{frame: @9, point: [0, 0, 1 cm]"),
                 "broken_path", "a load sits on the frame '9'"},
        BadInput{"EndEffectorOnNoFrame",
                 with("{frame: 2, point: [0, 0, 0]", "{frame: @gripper, point: [0, 0, 0]"), "broken_path",
                 "the end effector sits on the frame 'gripper'"},
        BadInput{"FromNowhere", with("from: 1, to: 2", "from: @7, to: 2"), "broken_path",
                 "the frame '7' has no path to the ground frame '0': no transform makes it"},
        BadInput{"Circle", with("from: 0, to: 1", "from: @2, to: 1"), "broken_path",
                 "the frame '2' has no path to the ground frame '0': its transforms form a circle"},
        BadInput{"FrameTwice", with("from: 1, to: 2", "from: 0, to: @1"), "doubly_defined",
                 "two transforms make the frame '1', the first at line 13"},
        BadInput{"ToTheGround", with("from: 1, to: 2", "from: 1, to: @0"), "doubly_defined",
                 "a transform to the ground frame '0'"},
        BadInput{"FromAList", with("from: 1, to: 2", "from: @[1], to: 2"), "wrong_kind",
                 "expected a frame's name"},
        BadInput{"TimeInATransform", with("theta: q1 + 5 deg", "theta: @t / 1 s"), "varying_number",
                 "by coordinates only, not by time directly; name a coordinate with that constraint"},
        BadInput{"CurvedInACoordinate", with("theta: q1 + 5 deg", "theta: @q1^2"), "varying_number",
                 "not affine in 'q1'"},
        BadInput{"TwoCoordinates", with("s: q2, ", "s: @q2, theta: q1, "), "varying_number",
                 "a second varying coordinate 'q2'"},
        BadInput{"VaryingLength", with("a: half", "a: @q2"), "varying_number",
                 "a and alpha are constant; 'q2' may vary theta or s"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Numbers, RefusedScene,
    testing::Values(
        BadInput{"NegativeMass", with("mass: 1 kg", "mass: @-1 kg"), "negative_mass",
                 "'slider' has a mass of -1 kg; expected 0 or more"},
        BadInput{
            "NegativeDefaultMass",
            with("bob: 3 kg", "bob: -3 kg").insert(with("bob: 3 kg", "bob: -3 kg").find("bob, center"), "@"),
            "negative_mass", "'weight' has a mass of -3 kg"},
        BadInput{"NegativeStiffness", with("8 N/mm", "@-8 N/mm"), "negative_stiffness",
                 "the stiffness is -8000, which drives the coordinate away; expected 0 or more"},
        BadInput{"StiffnessOfAnAngle", with("8 N/mm", "@8 N m"), "wrong_dimension", "the stiffness"},
        BadInput{"SpringOnNothing", with("coordinate: q2", "coordinate: @q3"), "undefined_symbol",
                 "acts on 'q3', which is no coordinate"},
        BadInput{"SpringAlongAMass", with("coordinate: q2, ", "along: @bob * q1, "), "wrong_dimension",
                 "what a load acts along is a mass (kg); expected an angle or a length"},
        BadInput{"SpringAlongNothing", with("coordinate: q2, ", "along: @3 cm + half + t * 1 m/s, "),
                 "undefined_symbol",
                 "what a load acts along names no coordinate; expected a formula of coordinates"},
        BadInput{"SpringAlongAnUnknown", with("coordinate: q2, ", "along: @q3 + psi1, "), "undefined_symbol",
                 "undefined symbol 'q3'"},
        BadInput{"SpringAlongAnAngle", with("coordinate: q2, stiffness: ", "along: q1 - psi1, stiffness: @"),
                 "wrong_dimension", "the stiffness"},
        BadInput{"RestAlongAnAngle",
                 with("coordinate: q2, stiffness: 8 N/mm, rest: ",
                      "along: q1 - psi1, stiffness: 8 N m/rad, rest: @"),
                 "wrong_dimension", "the rest is a length (m); expected a number or an angle"},
        BadInput{"NegativeStiffnessAlong",
                 with("coordinate: q2, stiffness: ", "along: q2 + 1 cm, stiffness: @-"), "negative_stiffness",
                 "the stiffness is -8000, which drives what it acts along away; expected 0 or more"},
        BadInput{
            "NegativeDampingAlong",
            with("coordinate: q2, stiffness: 8 N/mm, rest: 1 cm", "along: q2 + 1 cm, damping: @-3 N s/m"),
            "negative_stiffness", "the damping is -3, which drives what it acts along away"},
        BadInput{"NotFiniteAlong", with("coordinate: q2, ", "along: @1 cm * sqrt(-1 - q1^2), "), "not_finite",
                 "what a load acts along is not finite"},
        BadInput{"LoadAlongWithoutALaw",
                 with("{coordinate: q2, stiffness: 8 N/mm, rest: 1 cm}", "@{along: q2 + 1 cm}"),
                 "missing_key",
                 "a load along a formula lacks both 'stiffness' and 'damping'; expected one of them or both"},
        BadInput{"LoadBetweenWithoutALaw",
                 with("{coordinate: q2, stiffness: 8 N/mm, rest: 1 cm}",
                      "@{between: [{frame: 0}, {frame: 2}], rest: 1 cm}"),
                 "missing_key", "a load between two points lacks both"},
        BadInput{"BetweenWithoutARest",
                 with("{coordinate: q2, stiffness: 8 N/mm, rest: 1 cm}",
                      "@{between: [{frame: 0}, {frame: 2}], stiffness: 8 N/mm}"),
                 "missing_key",
                 "a stiffness between two points lacks the key 'rest'; expected the length at which it pulls "
                 "nothing"},
        BadInput{"BetweenThree", with("coordinate: q2, ", "between: @[{frame: 0}, {frame: 2}, {frame: 1}], "),
                 "wrong_size", "found a list of 3; expected the two ends of a load"},
        BadInput{
            "BetweenOnNoFrame", with("coordinate: q2, ", "between: [{frame: 0}, {frame: @3}], "),
            "broken_path",
            "an end of a load sits on the frame '3', which no transform makes; expected one of '0', '1', "
            "'2'"},
        BadInput{"BetweenWithoutAFrame",
                 with("coordinate: q2, ", "between: [{frame: 0}, @{point: [0, 0, 0]}], "), "missing_key",
                 "an end of a load lacks the key 'frame'"},
        BadInput{"BetweenOneBody",
                 with("coordinate: q2, ", "between: @[{frame: 2}, {frame: 2, point: [1 cm, 0, 0]}], "),
                 "out_of_range",
                 "a load between two points of one rigid body moves nothing; expected frames with a joint "
                 "between them"},
        BadInput{"PointInRadians",
                 with("coordinate: q2, ", "between: [{frame: 0, point: [@1 rad, 0, 0]}, {frame: 2}], "),
                 "wrong_dimension", "the point is a number or an angle; expected a length (m)"},
        BadInput{
            "BetweenInNewtonMetres",
            with("coordinate: q2, stiffness: 8 N/mm", "between: [{frame: 0}, {frame: 2}], stiffness: @8 N m"),
            "wrong_dimension", "the stiffness"},
        BadInput{"NegativeRestBetween",
                 with("coordinate: q2, stiffness: 8 N/mm, rest: ",
                      "between: [{frame: 0}, {frame: 2}], stiffness: 8 N/mm, rest: @-"),
                 "out_of_range", "the rest length between two points is -0.01 m; expected 0 or more"},
        BadInput{"NegativeStiffnessBetween",
                 with("coordinate: q2, stiffness: ", "between: [{frame: 0}, {frame: 2}], stiffness: @-"),
                 "negative_stiffness", "the stiffness is -8000, which drives the points away"},
        BadInput{"BacklashOfASpring", with("coordinate: q2, ", "along: q2, @backlash: 1 mm, "), "unknown_key",
                 "unknown key 'backlash' in a load along a formula"},
        BadInput{"SpringAtAPoint", with("coordinate: q2", "coordinate: q2, @point: [0, 0, 0]"), "unknown_key",
                 "unknown key 'point' in a load at a coordinate"},
        BadInput{"NegativeMoment", with("xx: 1 kg m^2", "xx: @-1 kg m^2"), "impossible_inertia",
                 "a principal moment of inertia of -1 kg m^2"},
        BadInput{"ProductTooLarge",
                 with("xx: 1 kg m^2, yy: 2 kg m^2", "xx: @1 kg m^2, yy: 1 kg m^2, xy: 1.5 kg m^2"),
                 "impossible_inertia",
                 "-0.5 kg m^2 (is it given about another point than the centre of mass?)"},
        BadInput{"Nan", with("length: 2 m", "length: @.nan"), "not_finite", "a number that is not finite"},
        BadInput{"Infinity", with("mass: 1 kg", "mass: @.inf"), "not_finite", "not finite"},
        BadInput{"TooLarge", with("mass: 1 kg", "mass: @1e400 kg"), "not_finite", "too large"},
        BadInput{"DivisionByZero", with("psi1 / 4", "psi1 @/ (length - 2 m)"), "not_finite",
                 "a division by zero"},
        BadInput{"NotFiniteAtHome", with("psi1 / 4", "@1 / (psi1 - 120 deg)"), "not_finite",
                 "the coordinate 'q1' is not finite at these parameters, at home at t = 0"},
        BadInput{"NotFiniteByDefault", with("mass: 1 kg", "mass: @1 kg^2 / (bob - 3 kg)"), "not_finite",
                 "the mass is not finite"},
        BadInput{"NotFiniteGravity", with("-9.81 m/s^2", "@-9.81 m kg/s^2 / (bob - 3 kg)"), "not_finite",
                 "gravity is not finite"},
        BadInput{"ForceAtTheStart",
                 with("sin(t / 1 s)", "sin(t / 1 s) / (t / 1 s)").insert(kScene.find("10 N"), "@"),
                 "not_finite", "the load's force is not finite"},
        BadInput{"HomeOfAParameter", with("120 deg", "@120 deg * bob / 1 kg"), "varying_number",
                 "home depends on no parameter"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Files, RefusedScene,
    testing::Values(BadInput{"Empty", "", "empty_file", "found nothing"},
                    BadInput{"Binary", std::string("@\0\1\2\3", 5), "not_text", "the byte 0x00"},
                    BadInput{"NoYaml",
                             with("motors: [psi1]\n", "motors: [psi1\n")
                                 .insert(with("motors: [psi1]\n", "motors: [psi1\n").find(": [q1, q2]"), "@"),
                             "invalid_yaml", "no valid YAML"},
                    BadInput{
                        "DeepFormula",
                        with("length: 2 m", "length: " + std::string(64, '(') + "@2" + std::string(64, ')')),
                        "too_deep", "nested deeper than 64 levels"}),
    bad_input_name);

/// The scene above with `count` more lines at the head of a section.
std::string lengthened(const std::string& section, int count, const std::function<std::string(int)>& line) {
  std::string added = "\n" + section + ":\n";
  for (int i = 0; i < count; ++i) added += line(i);
  return with("\n" + section + ":\n", added);
}

InputError refused(const std::string& text) {
  return *input_error([&] { loaded(text, "long.yaml"); });
}

// ctest's time limit is the judge of the next ones.

TEST(LoadSceneLimits, ConstantsThatAreWrittenOutManyTimes) {
  std::string constants = "  c0: bob\n";
  for (int i = 1; i <= 6; ++i) constants += fmt::format("  c{0}: c{1} + c{1} + c{1}\n", i, i - 1);
  for (int i = 0; i < 10'000; ++i) constants += fmt::format("  d{}: c6\n", i);
  const auto error = refused(lengthened("constants", 1, [&](int) { return constants; }));
  EXPECT_EQ(error.code, "too_large");
  EXPECT_NE(error.message.find("more than 100000 terms, constants written out"), std::string::npos)
      << error.message;
}

TEST(LoadSceneLimits, ManyConstantsAreRead) {
  const auto in_chains_of_100 = [](int i) {
    return i % 100 == 99 ? fmt::format("  c{}: 1\n", i) : fmt::format("  c{}: c{} + 1\n", i, i + 1);
  };
  EXPECT_EQ(loaded(lengthened("constants", 30'000, in_chains_of_100)).canonical, loaded(kScene).canonical);
}

TEST(LoadSceneLimits, ChainsOfDefinitionsAreBounded) {
  const auto error =
      refused(lengthened("constants", 1000, [](int i) { return fmt::format("  c{}: c{}\n", i, i + 1); }));
  EXPECT_EQ(error.code, "too_deep");
}

TEST(LoadSceneLimits, ManyTransformsFromTheTipToTheGround) {
  const auto backwards = [](int count) {
    return lengthened("transforms", count, [count](int i) {
      return fmt::format("  - {{from: {}, to: f{}}}\n", i + 1 == count ? "2" : fmt::format("f{}", i + 1), i);
    });
  };
  EXPECT_EQ(loaded(backwards(998)).transforms.size(), 1000U);
  EXPECT_EQ(refused(backwards(999)).code, "wrong_size");
}

TEST(LoadSceneLimits, ManyNamesOfEachKind) {
  const auto list = [](int count, const char* name) {
    std::string names;
    for (int i = 0; i < count; ++i) names += fmt::format(", {}{}", name, i);
    return names;
  };
  EXPECT_EQ(refused(with("motors: [psi1", "motors: [psi1" + list(64, "p"))).code, "wrong_size");
  EXPECT_EQ(refused(with("coordinates: [q1, q2", "coordinates: [q1, q2" + list(30'000, "c"))).code,
            "wrong_size");
  EXPECT_EQ(
      refused(lengthened("parameters", 30'000, [](int i) { return fmt::format("  p{}: 1\n", i); })).code,
      "wrong_size");
  EXPECT_EQ(refused(lengthened("bodies", 10'000, [](int) { return "  - {frame: 1, mass: 1}\n"; })).code,
            "wrong_size");
  EXPECT_EQ(refused(lengthened("loads", 10'000, [](int) { return "  - {frame: 1}\n"; })).code, "wrong_size");
  EXPECT_EQ(
      refused(lengthened("constraints", 30'000, [](int i) { return fmt::format("  x{}: 1\n", i); })).code,
      "undefined_symbol");
}

}  // namespace
}  // namespace mixloop
