#include "app/signal_log.h"

#include <gmock/gmock.h>

#include <cmath>

#include "maps/error.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::app {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class SignalLogFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    test::write_text(folder_ / "log.csv", text);
    return folder_ / "log.csv";
  }
  void expect_refused(const std::string& text, const std::string& why,
                      const SignalColumns& columns = {}) {
    const auto file = write(text);
    EXPECT_THAT([&] { read_signal_logs(file, columns); },
                ThrowsMessage<maps::InputError>(HasSubstr(why)))
        << text;
  }
  test::TemporaryFolder folder_;
};

TEST_F(SignalLogFile, FindsTimeSetpointAndResponseByName) {
  const auto logs = read_signal_logs(
      write("# logged by hand\nresponse_m_s,time_s,Set-point [m/s]\n0.1,0,1\n0.2,0.5,2\r\n"), {});
  ASSERT_EQ(logs.size(), 1U);
  EXPECT_EQ(logs[0].unit, "m/s");
  ASSERT_EQ(logs[0].samples.size(), 2U);
  EXPECT_EQ(logs[0].samples[1].time_s, 0.5);
  EXPECT_EQ(logs[0].samples[1].setpoint, 2.0);
  EXPECT_EQ(logs[0].samples[1].response, 0.2);
}

TEST_F(SignalLogFile, TakesAnyThreeColumnsInThatOrder) {
  const auto logs = read_signal_logs(write("time,voltage,rpm\n0,1,2\n"), {});
  ASSERT_EQ(logs.size(), 1U);
  EXPECT_EQ(logs[0].setpoint_column, "voltage");
  EXPECT_EQ(logs[0].response_column, "rpm");
}

TEST_F(SignalLogFile, FindsForwardSpeedAndTurnRateInADrivesLog) {
  const auto logs = read_signal_logs(
      write("t_s,command_v_m_s,command_w_rad_s,true_v_m_s,true_w_rad_s,pose_quality\n"
            "0,0.4,0.1,0.3,0.05,good\n"),
      {});
  ASSERT_EQ(logs.size(), 2U);
  EXPECT_EQ(logs[0].name, "forward speed");
  EXPECT_EQ(logs[0].samples[0].response, 0.3);
  EXPECT_EQ(logs[1].name, "turn rate");
  EXPECT_EQ(logs[1].samples[0].setpoint, 0.1);
}

TEST_F(SignalLogFile, HoldsTheSetpointAndLeavesOutWhatWasNotMeasured) {
  const auto samples =
      read_signal_logs(write("time_s,setpoint,response\n0,1,0\n0.1,,\n0.2,,nan\n0.3,2,5\n"), {})[0]
          .samples;
  EXPECT_EQ(samples[1].setpoint, 1.0);
  EXPECT_TRUE(std::isnan(samples[1].response));
  EXPECT_TRUE(std::isnan(samples[2].response));
  EXPECT_EQ(samples[3].response, 5.0);
}

TEST_F(SignalLogFile, TakesTheColumnsItIsGiven) {
  const SignalColumns columns{.setpoint = "b", .response = "d"};
  const auto logs = read_signal_logs(write("time_s,a,b,c,d\n0,1,2,3,4\n"), columns);
  EXPECT_EQ(logs[0].samples[0].setpoint, 2.0);
  EXPECT_EQ(logs[0].samples[0].response, 4.0);
  expect_refused("time_s,setpoint,response\n", "nearest is \"setpoint\"",
                 {.setpoint = "setpiont", .response = "response"});
  expect_refused("time_s,setpoint,response\n", "go together",
                 {.setpoint = "setpoint", .response = std::nullopt});
}

TEST_F(SignalLogFile, RefusesWhatItCannotReadAndSaysWhere) {
  expect_refused("", "is empty");
  expect_refused("0,1,2\n", "is no header");
  expect_refused("speed,setpoint,response\n0,1,2\n", "no column of times");
  expect_refused("time_s,a,b,c\n0,1,2,3\n", "--setpoint and --response");
  expect_refused("time_s,setpoint,response\n0,1,2\n1,2\n", "line 3: 2 values in place of 3");
  expect_refused("time_s,setpoint,response\n0,1,2\n1,x,2\n", "line 3: setpoint = \"x\"");
  expect_refused("time_s,setpoint,response\n1,1,2\n0,1,2\n", "line 3: time_s = 0 goes back");
  expect_refused("time_s,setpoint,response\n,1,2\n", "goes back in time");
  expect_refused("time_s,setpoint,response\n0,1,1e999\n", "not a finite number");
}

}  // namespace
}  // namespace rovigo::app
