// SPDX-License-Identifier: MIT
// Laws without gains: torques that depend on the time alone, and the feedback of the whole state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/guarded_controller.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"
#include "tests/support/crane.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;

/// The robot has three motors that turn; the crane one that slides, and a load that swings freely.
const Scene& paper_scene() {
  static const Scene scene =
      load_scene(read_document(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml"));
  return scene;
}

TorqueCourse formulas(const std::string& text) {
  return TorqueCourse::of_formulas(parse_document(text, "torque.yaml"), paper_scene());
}

TorqueCourse table(const ScratchFolder& folder, const std::string& text) {
  folder.write("torques.csv", text);
  return TorqueCourse::of_file(*parse_document("torques.csv", "torque.yaml"), folder.path(), paper_scene());
}

std::vector<double> at(const TorqueCourse& course, double t) {
  std::vector<double> tau(3);
  course.at(t, tau);
  return tau;
}

TEST(TorqueCourse, IsFormulasOfTheTime) {
  const TorqueCourse course = formulas("[1 N m, 2 N m/s * t, \"3 N m * cos(2*pi*1 Hz*t)\"]");
  EXPECT_THAT(at(course, 0), ElementsAre(1, 0, 3));
  EXPECT_THAT(at(course, 0.25), ElementsAre(1, 0.5, testing::DoubleNear(0, 1e-15)));
}

TEST(TorqueCourse, HoldsSamplesAndKeepsTheLast) {
  const ScratchFolder folder;
  const TorqueCourse course = table(folder,
                                    "t,a,b,c\n"
                                    "# a comment, and an empty line\n"
                                    "\n"
                                    "0,1,2,3\r\n"
                                    " 0.003 , -1.5e0,+2, 0.5\n"
                                    "0.01,7,8,9");
  EXPECT_THAT(at(course, 0), ElementsAre(1, 2, 3));
  EXPECT_THAT(at(course, 2.0 / 1000), ElementsAre(1, 2, 3));
  EXPECT_THAT(at(course, 3.0 / 1000), ElementsAre(-1.5, 2, 0.5)) << "from the very tick on";
  EXPECT_THAT(at(course, 0.00999), ElementsAre(-1.5, 2, 0.5));
  EXPECT_THAT(at(course, 1e6), ElementsAre(7, 8, 9));
}

TEST(TorqueCourse, MayBeginBeforeTheRun) {
  const ScratchFolder folder;
  EXPECT_THAT(at(table(folder, "-1,9,9,9\n-0.5,1,2,3\n"), 0), ElementsAre(1, 2, 3));
}

struct BadTable {
  const char* name;
  const char* text;
  int line, column;
  const char* message;
};

class TablesOfTorques : public testing::TestWithParam<BadTable> {};

TEST_P(TablesOfTorques, AreRefusedWithLineAndColumn) {
  const auto& [name, text, line, column, message] = GetParam();
  const ScratchFolder folder;
  const auto error = input_error([&] { table(folder, text); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "invalid_table");
  EXPECT_EQ(to_string(error->place), folder.file("torques.csv") + ":" + std::to_string(line) +
                                         (column > 0 ? ":" + std::to_string(column) : ""));
  EXPECT_THAT(error->what(), testing::HasSubstr(message));
}

INSTANTIATE_TEST_SUITE_P(
    Rows, TablesOfTorques,
    testing::Values(
        BadTable{"no_number", "0,1,2,3\n0.1,1,two,3\n", 2, 7,
                 "found 'two'; expected the torque of motor 'psi2'"},
        BadTable{"no_header_but_a_word", "time,1,2,3\n0,1,2,3\n", 1, 1, "found 'time'; expected the time"},
        BadTable{"empty_field", "0,1,,3\n", 1, 5, "found nothing; expected the torque of motor 'psi2'"},
        BadTable{"not_finite", "0,1,2,inf\n", 1, 7, "a finite number"},
        BadTable{"not_a_number", "nan,1,2,3\n", 1, 1, "a finite number"},
        BadTable{"number_and_more", "0,1,2,3 N\n", 1, 7, "found '3 N'"},
        BadTable{"too_short", "0,1,2,3\n0.1,1,2\n", 2, 8, "the row ends after 3 numbers; expected 4"},
        BadTable{"too_long", "0,1,2,3,4\n", 1, 9, "the row goes on after 4 numbers"},
        BadTable{"falls_back", "0,1,2,3\n0.2,1,2,3\n 0.1,1,2,3\n", 3, 2, "0.1 s comes after 0.2 s"},
        BadTable{"twice", "0,1,2,3\n0,1,2,3\n", 2, 1, "expected times that ascend"},
        BadTable{"begins_late", "t,a,b,c\n0.1,1,2,3\n", 2, 1,
                 "the first sample is at 0.1 s; expected one at 0 s"},
        BadTable{"header_alone", "t,a,b,c\n", 1, 0, "no sample"}, BadTable{"empty", "", 1, 0, "no sample"}),
    [](const auto& row) { return std::string(row.param.name); });

void read_for_robot(const std::string& text, const std::string& file) {
  read_controller_settings(parse_document(text, file), paper_scene());
}

class LawsWithoutGains : public testing::TestWithParam<BadInput> {};

TEST_P(LawsWithoutGains, AreRefusedAtTheirPlace) { expect_refused(GetParam(), read_for_robot); }

constexpr const char* kGain = "[[1,0,0,1,0,0],[0,1,0,0,1,0],[0,0,1,0,0,1]]";

INSTANTIATE_TEST_SUITE_P(
    Rows, LawsWithoutGains,
    testing::Values(
        BadInput{"wrong_unit", "{law: torque, torque: [1 N m, @2 N, 0]}", "wrong_dimension", "motor 'psi2'"},
        BadInput{"time_is_no_torque", "{law: torque, torque: [0, 0, @3 * t]}", "wrong_dimension", "psi3"},
        BadInput{"one_short", "{law: torque, torque: @[1, 2]}", "wrong_size",
                 "torque has 2 formulas; expected one for each of the 3 motors"},
        BadInput{"strange_name", "{law: torque, torque: [@tt, 0, 0]}", "undefined_symbol", "tt"},
        BadInput{"both", "{law: torque, torque: [0, 0, 0], file: @a.csv}", "doubly_defined", "one of them"},
        BadInput{"neither", "@{law: torque}", "missing_key", "lacks 'torque' or 'file'"},
        BadInput{"no_file", "{law: torque, file: @nowhere.csv}", "no_such_file", "'nowhere.csv'"},
        BadInput{"gain_of_no_use", "{law: torque, torque: [0, 0, 0], kp: @[1, 1, 1]}", "unknown_key",
                 "the law torque has no 'kp'; expected torque or file"},
        BadInput{"strange_key", "{law: torque, @tork: [0, 0, 0]}", "unknown_key", "tork"},
        BadInput{"torque_of_pd", "{law: pd, kp: [1, 1, 1], kv: [1, 1, 1], torque: @[0, 0, 0]}", "unknown_key",
                 "the law pd has no 'torque'"},
        BadInput{"pd_without_gains", "@{law: pd, kv: [1, 1, 1]}", "missing_key", "'kp'"},
        BadInput{"no_gain", "@{law: state_feedback}", "missing_key", "'gain'"},
        BadInput{"two_rows", "{law: state_feedback, gain: @[[1,0,0,1,0,0],[0,1,0,0,1,0]]}", "wrong_size",
                 "the gain has 2 rows; expected 3, one a motor"},
        BadInput{"short_row", "{law: state_feedback, gain: [[1,0,0,1,0,0],@[0,1,0],[0,0,1,0,0,1]]}",
                 "wrong_size", "row 2 of the gain has 3 values; expected 6"},
        BadInput{"unit_of_rates",
                 "{law: state_feedback, gain: [[1 N m,0,0,@1 N m,0,0],[0,1,0,0,1,0],[0,0,1,0,0,1]]}",
                 "wrong_dimension", "the gain"},
        BadInput{"about_too_few",
                 std::string("{law: state_feedback, gain: ") + kGain + ", about: {psi: @[0, 0]}}",
                 "wrong_size", "the position to feed back about has 2 values"},
        BadInput{"strange_about",
                 std::string("{law: state_feedback, gain: ") + kGain + ", about: {@tau: [0]}}", "unknown_key",
                 "tau"},
        BadInput{"damped", "{law: torque, torque: [0, 0, 0], safety: {safe_command: @damp}}", "out_of_range",
                 "damp takes kv, which the law torque has not"}),
    bad_input_name);

/// Of the crane: its trolley's motor, with the load's swing in the state.
struct FedBack {
  std::vector<double> psi{0.2, 0.5}, psid{3, 2}, row{0.1, 1, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  double tau = 0;

  void command(const std::string& text, double t = 0) {
    const ControllerSettings settings = read_controller_settings(parse_document(text, "law.yaml"), *crane());
    GuardedController controller(
        Controller({equations_of(crane(), Evaluation::interpreter, {}), {}}, settings), settings.safety,
        settings.kv);
    controller.torque({psi, psid, t}, reference_in(row, 1), {&tau, 1});
  }
};

TEST(StateFeedback, IsOfTheWholeStateLessTheMotorsReferenceAndTheFreeOnesAbout) {
  FedBack crane;
  crane.command(
      "{law: state_feedback, gain: [[10, 100, 1000, 1e4]], about: {psi: [9, 0.25], psid: [9, 1], torque: [7 "
      "N]}}");
  EXPECT_DOUBLE_EQ(crane.tau, 7 - (10 * (0.2 - 0.1) + 100 * (0.5 - 0.25) + 1000 * (3 - 1) + 1e4 * (2 - 1)));
}

TEST(StateFeedback, IsAboutHomeAtRestUnlessItIsSaid) {
  FedBack crane;
  crane.row = std::vector<double>(12, 0.0);
  crane.command("{law: state_feedback, gain: [[10 N/m, 100 N, 1000 N s/m, 1e4 N s]]}");
  EXPECT_DOUBLE_EQ(crane.tau, -(10 * 0.2 + 100 * 0.5 + 1000 * 3 + 1e4 * 2));
}

TEST(Torque, OfALinearMotorIsAForceWhateverTheState) {
  FedBack crane;
  crane.command("{law: torque, torque: [2 N/s * t]}", 3);
  EXPECT_EQ(crane.tau, 6);
}

}  // namespace
}  // namespace mixloop
