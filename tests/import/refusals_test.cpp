// SPDX-License-Identifier: MIT
#include "import/import_urdf.hpp"
#include "tests/import/robots.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

class BadUrdf : public testing::TestWithParam<BadInput> {};

TEST_P(BadUrdf, IsRefused) {
  expect_refused(GetParam(),
                 [](const std::string& text, const std::string& file) { import_urdf(text, file, {}); });
}

/// A robot of one joint and more.
std::string robot(const std::string& more = "", const std::string& axis = R"(<axis xyz="0 0 1"/>)",
                  const std::string& inertial = R"(<inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)") {
  return R"(<?xml version="1.0"?>
<!-- <link name="no link"/> -->
<robot name="one">
  <link name="base"/>
  <link name="arm">)" +
         inertial + R"(</link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    )" + axis +
         R"(<limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
)" + more +
         "</robot>\n";
}

std::string arm(const std::string& inertial) { return robot("", R"(<axis xyz="0 0 1"/>)", inertial); }

std::string joint(const std::string& begin, const std::string& parent, const std::string& child,
                  const std::string& inside = "") {
  return "  " + begin + "><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/>" + inside +
         "</joint>\n";
}

const std::string kBody =
    R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";
std::string link(const std::string& name) { return "  <link name=\"" + name + "\">" + kBody + "</link>\n"; }

INSTANTIATE_TEST_SUITE_P(
    Files, BadUrdf,
    testing::Values(BadInput{"nothing", "", "empty_file", "expected XML"},
                    BadInput{"bytes", "<robot>@\x01</robot>", "not_text", "0x01"},

                    BadInput{"a_comment", "<!-- nothing -->", "invalid_xml", "no element"},
                    BadInput{"a_scene_of_gazebo", "@<sdf version='1.6'/>", "not_urdf", "found <sdf>"},
                    BadInput{"a_macro",
                             "<robot name='r' xmlns:xacro='x'>\n  @<xacro:include filename='a'/></robot>",
                             "not_urdf", "expand it"},
                    BadInput{"no_name", "@<robot/>", "missing_key", "lacks 'name'"},
                    BadInput{"no_link", "@<robot name='r'/>", "missing_key", "has no <link>"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Trees, BadUrdf,
    testing::Values(
        BadInput{"two_links_of_a_name", robot("  <link @name=\"arm\"/>"), "doubly_defined",
                 "a second link 'arm'; the first stands at line 5"},
        BadInput{"two_joints_of_a_name",
                 robot("  <link name=\"end\"/>\n  <joint @name=\"turn\" type=\"fixed\"><parent "
                       "link=\"arm\"/><child link=\"end\"/></joint>"),
                 "doubly_defined", "a second joint 'turn'"},
        BadInput{"two_parents", robot(joint("@<joint name=\"again\" type=\"fixed\"", "base", "arm")),
                 "not_a_tree",
                 "the link 'arm' is the child of two joints, 'turn' at line 7 and 'again' here"},
        BadInput{"two_roots", robot("  @<link name=\"alone\"/>"), "not_a_tree",
                 "2 links have no parent, 'base' at line 4 and 'alone' here"},
        BadInput{"a_circle_beside",
                 robot("  @<link name=\"a\"/><link name=\"b\"/>\n" +
                       joint("<joint name=\"x\" type=\"fixed\"", "a", "b") +
                       joint("<joint name=\"y\" type=\"fixed\"", "b", "a")),
                 "not_a_tree", "'a' <- 'b' <- 'a'"},
        BadInput{"of_itself",
                 "<robot name='r'>@<link name='a'/>" + joint("<joint name=\"x\" type=\"fixed\"", "a", "a") +
                     "</robot>",
                 "not_a_tree", "'a' <- 'a'"},
        BadInput{
            "no_such_parent",
            robot("  <joint name=\"x\" type=\"fixed\"><parent @link=\"bose\"/><child link=\"arm\"/></joint>"),
            "undefined_symbol", "did you mean 'base'?"},
        BadInput{"no_child", robot("  @<joint name=\"x\" type=\"fixed\"><parent link=\"base\"/></joint>"),
                 "missing_key", "lacks <child"},
        BadInput{"no_type", robot(joint("@<joint name=\"x\"", "base", "arm")), "missing_key", "lacks 'type'"},
        BadInput{"no_such_type", robot(joint("<joint name=\"x\" @type=\"revolut\"", "base", "arm")),
                 "unknown_value", "did you mean 'revolute'?"},
        BadInput{"nothing_moves",
                 "<robot name='r'><link name='a'/><link name='b'/>" +
                     joint("<joint name=\"x\" type=\"fixed\"", "a", "b") + "</robot>",
                 "no_motor", "no joint moves"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Joints, BadUrdf,
    testing::Values(
        BadInput{"no_limit",
                 robot(link("end") + joint("@<joint name=\"x\" type=\"prismatic\"", "arm", "end")),
                 "missing_key", "lacks <limit>"},
        BadInput{"limits_the_wrong_way_round",
                 robot(link("end") + joint("<joint name=\"x\" type=\"revolute\"", "arm", "end",
                                           "<limit @lower=\"1\" upper=\"-1\" velocity=\"1\" effort=\"1\"/>")),
                 "out_of_range", "lower limit, 1, above its upper one, -1"},
        BadInput{
            "a_negative_speed",
            robot(link("end") + joint("<joint name=\"x\" type=\"revolute\"", "arm", "end",
                                      "<limit lower=\"-1\" upper=\"1\" @velocity=\"-1\" effort=\"1\"/>")),
            "out_of_range", "expected more than 0"},
        BadInput{"no_direction", robot("", R"(<axis @xyz="0 0 0"/>)"), "out_of_range",
                 "the axis of the joint 'turn' is 0 0 0"},
        BadInput{"two_numbers", robot("", R"(<axis @xyz="0 1"/>)"), "wrong_size",
                 "'xyz' has 2 numbers; expected 3"},
        BadInput{"no_number", robot("", R"(<axis  @xyz = '0 0 one'/>)"), "wrong_kind", "'one'"},
        BadInput{"not_finite", robot("", R"(<axis @xyz="0 0 nan"/>)"), "wrong_kind",
                 "expected a finite number"},
        BadInput{"a_minus_of_print", robot("", R"(<axis @xyz="0 0 −1"/>)"), "wrong_kind", "U+2212"},
        BadInput{"drives_itself", robot("", R"(<axis xyz="0 0 1"/><dynamics @damping="-1"/>)"),
                 "negative_stiffness", "damping"},
        BadInput{"mimics_nobody",
                 robot(link("end") + joint("<joint name=\"x\" type=\"continuous\"", "arm", "end",
                                           "<mimic @joint=\"turm\"/>")),
                 "undefined_symbol", "did you mean 'turn'?"},
        BadInput{"mimics_itself",
                 robot(link("end") +
                       joint("<joint name=\"x\" type=\"continuous\"", "arm", "end", "<mimic @joint=\"x\"/>")),
                 "cyclic_definition", "'x' -> 'x'"},
        BadInput{"mimic_each_other",
                 robot(link("b") +
                       joint("<joint name=\"x\" type=\"continuous\"", "arm", "b", "<mimic @joint=\"y\"/>") +
                       link("c") +
                       joint("<joint name=\"y\" type=\"continuous\"", "b", "c", "<mimic joint=\"x\"/>")),
                 "cyclic_definition", "'x' -> 'y' -> 'x'"},
        BadInput{"mimics_what_stands",
                 robot(link("b") + joint("<joint name=\"x\" type=\"fixed\"", "arm", "b") + link("c") +
                       joint("<joint name=\"y\" type=\"continuous\"", "b", "c", "<mimic @joint=\"x\"/>")),
                 "undefined_symbol", "doesn't turn or slide"},
        BadInput{"mimics_by_nothing",
                 robot(link("end") + joint("<joint name=\"x\" type=\"continuous\"", "arm", "end",
                                           "<mimic joint=\"turn\" @multiplier=\"0\"/>")),
                 "out_of_range", "multiplier of 0"}),
    bad_input_name);

INSTANTIATE_TEST_SUITE_P(
    Inertias, BadUrdf,
    testing::Values(
        BadInput{"none",
                 R"(<robot name="r"><link name="a"/>@<link name="b"/>)" +
                     joint("<joint name=\"x\" type=\"continuous\"", "a", "b") + "</robot>",
                 "massless_link", "the link 'b', which the joint 'x' moves, has no mass"},
        BadInput{
            "zero",
            arm(R"(@<inertial><mass value="0"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"),
            "massless_link", "expected <inertial> with a mass above 0"},
        BadInput{
            "negative",
            arm(R"(@<inertial><mass value="-1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"),
            "negative_mass", "-1 kg"},
        BadInput{
            "of_another_point",
            arm(R"(@<inertial><mass value="1"/><inertia ixx="1" ixy="2" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"),
            "impossible_inertia", "principal moment of inertia of -1"},
        BadInput{
            "nothing_about_its_axis",
            arm(R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="0"/></inertial>)"),
            "singular_mass", "'turn'"},
        BadInput{
            "too_wide",
            arm(R"(@<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="2.1"/></inertial>)"),
            "impossible_inertia", "take it as it is with --any-inertia"},
        BadInput{
            "no_moment",
            arm(R"(<inertial><mass value="1"/>@<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0"/></inertial>)"),
            "missing_key", "<inertia> lacks 'izz'"},
        BadInput{
            "a_mass_with_a_unit",
            arm(R"(<inertial><mass @value="1 kg"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)"),
            "wrong_size", "'value' has 2 numbers; expected 1"},
        BadInput{"no_mass_at_all",
                 "<robot name='r'><link name='a'/>\n<link name='b'>@<inertial/></link>" +
                     joint("<joint name=\"x\" type=\"continuous\"", "a", "b") + "</robot>",
                 "missing_key", "<inertial> lacks <mass>"}),
    bad_input_name);

TEST(Refusals, OfWhatIsNoXmlNameTheLine) {
  for (const auto& [text, line] :
       {std::pair{"name: robot\n", 1}, std::pair{"<robot name='r'>\n<link name='a'>\n</robot>", 2}}) {
    const auto error = input_error([&] { import_urdf(text, "bad.urdf", {}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, "invalid_xml");
    EXPECT_EQ(error->place.line, line);
  }
}

TEST(Refusals, OfUrdfdomAreQuotedAndNotPrinted) {
  testing::internal::CaptureStderr();
  const auto error = input_error(
      [] { import_urdf("<robot name='r' version='2.0'><link name='a'/></robot>", "bad.urdf", {}); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "invalid_urdf");
  EXPECT_NE(error->message.find("urdfdom refuses the file: '"), std::string::npos) << error->what();
}

TEST(Refusals, OfOptionsNameWhatThereIs) {
  const auto refused = [](ImportOptions options) {
    return *input_error([&] { imported_robot("ur5", std::move(options)); });
  };
  ImportOptions tip;
  tip.tip = "tool1";
  EXPECT_STREQ(refused(tip).what(), "--tip: 'tool1' is no link; did you mean 'tool0'?");
  tip.tip = "base_link";
  EXPECT_NE(refused(tip).message.find("a link that no joint moves"), std::string::npos);
  ImportOptions free;
  free.free = {"elbow"};
  EXPECT_EQ(refused(free).code, "unknown_value");
  EXPECT_NE(refused(free).message.find("'elbow' is no joint that moves by itself"), std::string::npos);
}

TEST(Refusals, OfAPumaAsMeasuredNameItsLine) {
  const auto error = input_error([] { import_urdf_file(robot_file("puma_560"), {}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "impossible_inertia");
  EXPECT_NE(error->message.find("'link3', 0.086 kg m^2, exceeds the sum of the two others, 0.0785"),
            std::string::npos);
}

TEST(Refusals, DepthIsBounded) {
  for (const int levels : {70, 100'000}) {
    std::string text = "<robot name='r'>";
    for (int i = 0; i < levels; ++i) text += "<a>";
    for (int i = 0; i < levels; ++i) text += "</a>";
    const auto error = input_error([&] { import_urdf(text + "</robot>", "deep.urdf", {}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, "too_deep");
  }
}

}  // namespace
}  // namespace mixloop
