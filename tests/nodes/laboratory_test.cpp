// The nodes as processes, on the transports of the laboratory: Modbus TCP, a pseudo-terminal, UDP multicast.
// In real time on a machine that may be busy: patience is generous, and nothing is asserted of how fast
// anything was.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>
#include <waverig/imu_t.hpp>
#include <waverig/truth_t.hpp>

#include "estimator/evaluation/results_io.h"
#include "lcmtypes/bus.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/error.h"
#include "lcmtypes/event_log.h"
#include "motion/kinematics/frames.h"
#include "tests/nodes/process.h"

namespace waverig {
namespace {

using namespace std::chrono_literals;

constexpr const char* kCampaign =
    "name = \"short\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 16.0\nrepeats = "
    "1\nramp_periods = 1\n"
    "rest_before_s = 3.0\n[calibration]\nenabled = false\n";
constexpr const char* kRun = "T04.00s_H050.0cm_r1";

// The arm as a calibration wheel for a compass that hangs beside the motor; the second run is with the pedestal turned.
constexpr const char* kCompassCampaign = R"(name = "compass"
methods = ["directional"]
[sweep]
periods_s = [2.0]
heights_cm = [60.0]
duration_s = 20.0
repeats = 2
turn_per_repeat_deg = 90.0
ramp_periods = 1
rest_before_s = 3.0
[place]
declination_deg = -8.5
[rig]
arm_azimuth_deg = 17.0
[rig.gondola]
sensor_from_pivot_m = [0.0, 0.0, 0.0]
[rig.motor]
distance_m = 0.3
stator_moment_Am2 = [0.1, -0.08, 0.15]
rotor_moment_Am2 = [0.05, 0.0, 0.05]
[sensor]
magnetometer = "MAG3110"
)";
constexpr const char* kCompassRun = "T02.00s_H060.0cm_r2";

// A port of this test's own: LCM on one port hears every group.
std::string bus_url() {
  return "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 20000) +
         "?ttl=0&recv_buf_size=4194304";
}

bool multicast_reaches_this_machine() {
  try {
    Bus from(bus_url()), to(bus_url());
    bool heard = false;
    to.subscribe_raw("PROBE", [&](std::string_view, const void*, std::size_t) { heard = true; });
    return eventually(
        [&] {
          from.publish_raw("PROBE", "x", 1);
          to.handle(20);
          return heard;
        },
        2s);
  } catch (const UserError&) {
    return false;
  }
}

class Laboratory : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!multicast_reaches_this_machine()) GTEST_SKIP() << "no UDP multicast from this machine to itself";
    temporary_.write("short.toml", kCampaign);
  }
  std::string path(const std::string& name) const { return (temporary_ / name).string(); }

  std::unique_ptr<Process> node(const std::string& name, std::vector<std::string> arguments) {
    std::vector<std::string> command{WAVERIG_PROGRAM, "node"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    command.insert(command.end(), {"--bus", bus_url()});
    return std::make_unique<Process>(temporary_, name, command);
  }
  std::unique_ptr<Process> rig_sim() {
    auto rig = node("rig-sim", {"rig-sim", path(campaign_), "--run", run_, "--port", "0", "--serial-link",
                                path("line"), "--watchdog-ms", "1500"});
    EXPECT_TRUE(rig->says("serial ", 30s)) << rig->err();
    return rig;
  }
  // Late cycles and answers are forgiven: the machine may be busy with other things.
  std::unique_ptr<Process> motion(const Process& rig) {
    const std::string out = rig.out();
    const std::size_t at = out.find("tcp://");
    return node("motion", {"motion", path(campaign_), "--run", run_, "--drive",
                           out.substr(at, out.find('\n') - at), "--max-cycle-gap-ms", "1000",
                           "--response-timeout-ms", "400", "--max-following-error-deg", "40"});
  }

  TemporaryDirectory temporary_;
  std::string campaign_ = "short.toml", run_ = kRun;
};

double mean_height_m(const evaluation::CampaignResults& results, const std::string& method) {
  for (const auto& cell : results.cells)
    if (cell.method == method) return cell.statistics.mean_height_m;
  return std::nan("");
}

evaluation::RunResult run_named(const evaluation::CampaignResults& results, const std::string& name) {
  for (const auto& run : results.runs)
    if (run.run == name) return run;
  ADD_FAILURE() << "no run " << name;
  return {};
}

TEST_F(Laboratory, WholeRunFromDriveToResultsAndSomeoneElsesProgramIsJudgedToo) {
  auto rig = rig_sim();
  auto acquisition = node("acquisition", {"acquisition", path("short.toml"), "--serial", path("line")});
  auto harmonic =
      node("harmonic", {"estimator", "harmonic", "--campaign", path("short.toml"), "--one-record"});
  auto realtime = node("realtime", {"estimator", "realtime", "--one-record"});
  auto recorder = node("recorder", {"recorder", "--out", path("run.lcm"), "--one-record"});
  auto evaluator = node(
      "evaluator", {"evaluator", "--run", kRun, "--out", path("results"), "--campaign", path("short.toml")});
  for (auto* each : {&acquisition, &harmonic, &realtime, &recorder, &evaluator})
    ASSERT_TRUE((*each)->says("ready", 60s)) << (*each)->err();
  Process outsider(temporary_, "outsider", {WAVERIG_OUTSIDER, bus_url(), "1.1"});

  auto arm = motion(*rig);
  ASSERT_EQ(arm->wait(150s), 0) << arm->err();
  for (auto* each : {&harmonic, &realtime, &recorder, &evaluator})
    EXPECT_EQ((*each)->wait(90s), 0) << (*each)->err();
  acquisition->signal(SIGTERM);
  EXPECT_EQ(acquisition->wait(30s), 0) << acquisition->err();
  rig->signal(SIGINT);
  EXPECT_EQ(rig->wait(30s), 0) << rig->err();
  EXPECT_FALSE(std::filesystem::exists(temporary_ / "line")) << "the rig takes its name of the line with it";

  const evaluation::CampaignResults results = evaluation::read_results(temporary_ / "results");
  ASSERT_EQ(results.cells.size(), 3u) << outsider.err();
  EXPECT_NEAR(mean_height_m(results, "outsider"), 1.1 * 0.5, 0.01) << "its gain is known";
  EXPECT_NEAR(mean_height_m(results, "harmonic"), 0.5, 0.05) << "uncalibrated";
  EXPECT_NE(evaluator->out().find("outsider"), std::string::npos);

  EventLogReader log(temporary_ / "run.lcm");
  std::map<std::string, int> events;
  for (LogEvent event; log.next(event);) ++events[event.channel];
  EXPECT_EQ(events["WAVERIG_RECORD"], 2);
  EXPECT_GT(events["WAVERIG_IMU"], 2000);
  EXPECT_GT(events["WAVERIG_HEAVE_realtime"], 2000);
  EXPECT_GT(events["WAVERIG_HEAVE_outsider"], 1000);
}

TEST_F(Laboratory, CompassBesideTheMotorTellsThroughTheNodesWhatItTellsEmbedded) {
  campaign_ = "compass.toml";
  run_ = kCompassRun;
  temporary_.write(campaign_, kCompassCampaign);
  Process sweep(temporary_, "sweep", {WAVERIG_PROGRAM, "sweep", path(campaign_), "--out", path("embedded")});
  ASSERT_EQ(sweep.wait(120s), 0) << sweep.err();
  const std::string calibration = path("embedded/calibration.json");

  auto rig = rig_sim();
  auto acquisition = node(
      "acquisition", {"acquisition", path(campaign_), "--serial", path("line"), "--calibration", calibration});
  auto directional = node("directional", {"estimator", "directional", "--campaign", path(campaign_),
                                          "--calibration", calibration, "--one-record"});
  auto evaluator =
      node("evaluator", {"evaluator", "--run", run_, "--out", path("results"), "--campaign", path(campaign_)});
  for (auto* each : {&acquisition, &directional, &evaluator})
    ASSERT_TRUE((*each)->says("ready", 60s)) << (*each)->err();
  auto arm = motion(*rig);
  ASSERT_EQ(arm->wait(150s), 0) << arm->err();
  EXPECT_EQ(directional->wait(90s), 0) << directional->err();
  EXPECT_EQ(evaluator->wait(90s), 0) << evaluator->err();

  const evaluation::RunResult there = run_named(evaluation::read_results(temporary_ / "results"), run_);
  const evaluation::RunResult embedded = run_named(evaluation::read_results(temporary_ / "embedded"), run_);
  ASSERT_EQ(there.seas.size(), 1u);
  ASSERT_EQ(embedded.seas.size(), 1u);
  const estimator::SeaState &sea = there.seas[0].sea, &expected = embedded.seas[0].sea;
  // The arm's plane, 17 degrees and 90 more, in which the sensor goes round: that is where the sea comes from.
  EXPECT_NEAR(sea.mean_direction_rad, 107 * kDegree, 1.5 * kDegree);
  EXPECT_NEAR(sea.mean_direction_rad, expected.mean_direction_rad, 1 * kDegree);
  EXPECT_NEAR(sea.check_factor, expected.check_factor, 0.02);
}

// Hears the arm through the truth on the bus.
class Watcher {
 public:
  explicit Watcher(Bus& bus) : bus_(bus) {
    bus.subscribe<truth_t>(channel::kTruth, [this](const truth_t& m) {
      if (std::abs(m.arm_angle_rad - angle_rad_) > 1e-3) {
        angle_rad_ = m.arm_angle_rad;
        moved_utime_ = m.utime;
      }
      utime_ = m.utime;
    });
  }
  bool turns(Seconds patience) {
    const double begin_rad = look();
    return eventually([&] { return std::abs(look() - begin_rad) > 0.5; }, patience);
  }
  // For two seconds of the rig's time.
  bool stands(Seconds patience) {
    return eventually([&] { return look(), utime_ - moved_utime_ > 2000000; }, patience);
  }

 private:
  double look() {
    bus_.handle(50);
    bus_.drain();
    return angle_rad_;
  }
  Bus& bus_;
  double angle_rad_ = 0;
  std::int64_t utime_ = 0, moved_utime_ = 0;
};

TEST_F(Laboratory, KilledMotionNodeLeavesTheDriveStoppedAndNothingIsJudged) {
  auto rig = rig_sim();
  auto evaluator = node("evaluator", {"evaluator", "--run", kRun, "--out", path("results")});
  ASSERT_TRUE(evaluator->says("ready", 60s)) << evaluator->err();
  Bus bus(bus_url());
  Watcher arm(bus);
  auto first = motion(*rig);
  ASSERT_TRUE(arm.turns(60s)) << first->err();
  first->signal(SIGKILL);
  EXPECT_TRUE(arm.stands(60s));
  EXPECT_EQ(evaluator->wait(60s), 1);
  EXPECT_NE(evaluator->err().find("fell silent"), std::string::npos) << evaluator->err();
  EXPECT_FALSE(std::filesystem::exists(temporary_ / "results"));
}

TEST_F(Laboratory, ToldToStopMotionStopsTheDriveAndSaysSo) {
  auto rig = rig_sim();
  auto evaluator =
      node("evaluator", {"evaluator", "--run", kRun, "--out", path("results"), "--quiet-s", "0.2"});
  ASSERT_TRUE(evaluator->says("ready", 60s)) << evaluator->err();
  Bus bus(bus_url());
  Watcher arm(bus);
  auto node = motion(*rig);
  ASSERT_TRUE(arm.turns(60s)) << node->err();
  node->signal(SIGTERM);
  EXPECT_EQ(node->wait(60s), 1);
  EXPECT_NE(node->err().find("as told"), std::string::npos) << node->err();
  EXPECT_TRUE(arm.stands(60s));
  EXPECT_EQ(evaluator->wait(60s), 1);
  EXPECT_NE(evaluator->err().find("as told"), std::string::npos) << evaluator->err();
}

TEST_F(Laboratory, DriveThatGoesAwayIsAnAlarmWithItsReason) {
  auto rig = rig_sim();
  Bus bus(bus_url());
  Watcher arm(bus);
  auto node = motion(*rig);
  ASSERT_TRUE(arm.turns(60s)) << node->err();
  rig->signal(SIGKILL);
  EXPECT_EQ(node->wait(90s), 1);
  EXPECT_NE(node->err().find("alarm"), std::string::npos) << node->err();
}

// SIGHUP, as where the connection to the laboratory's machine is lost; under nohup it tells nothing.
TEST_F(Laboratory, AClosedTerminalEndsANodeWell) {
  for (const auto& [ignored, status] : {std::pair{false, 0}, {true, 128 + SIGKILL}}) {
    const auto before = ::signal(SIGHUP, ignored ? SIG_IGN : SIG_DFL);  // as the node will have it
    auto recorder = node("recorder", {"recorder", "--out", path("run.lcm"), "--replace"});
    ::signal(SIGHUP, before);
    ASSERT_TRUE(recorder->says("ready", 60s)) << recorder->err();
    recorder->signal(SIGHUP);
    if (ignored) {
      std::this_thread::sleep_for(300ms);
      recorder->signal(SIGKILL);
    }
    EXPECT_EQ(recorder->wait(60s), status) << recorder->err();
    EXPECT_EQ(std::filesystem::exists(temporary_ / "run.lcm.part"), ignored);
  }
}

TEST_F(Laboratory, RecorderToldToStopLeavesAWholeLog) {
  constexpr int kMessages = 2000;
  auto recorder = node("recorder", {"recorder", "--out", path("run.lcm")});
  ASSERT_TRUE(recorder->says("ready", 60s)) << recorder->err();
  Bus bus(bus_url());
  for (std::int64_t seq = 0; seq < kMessages; ++seq) {
    imu_t m{};
    m.utime = 1000 * seq;
    m.seq = seq;
    bus.publish(channel::kImu, m);
    if (seq % 20 == 0) std::this_thread::sleep_for(1ms);
  }
  recorder->signal(SIGTERM);
  ASSERT_EQ(recorder->wait(60s), 0) << recorder->err();
  EXPECT_FALSE(std::filesystem::exists(temporary_ / "run.lcm.part"));
  EventLogReader log(temporary_ / "run.lcm");
  LogEvent event;
  imu_t m{};
  int events = 0;
  while (log.next(event)) {
    ASSERT_TRUE(event.decode(m));
    EXPECT_EQ(m.seq, events++);
  }
  EXPECT_EQ(events, kMessages);
}

TEST_F(Laboratory, BadAddressesAndMissingDevicesAreOneSentenceAndExitTwo) {
  const std::string campaign = path("short.toml");
  const auto refuses = [&](const std::vector<std::string>& arguments, const std::string& complaint) {
    std::vector<std::string> command{WAVERIG_PROGRAM, "node"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    Process process(temporary_, "bad", command);
    EXPECT_EQ(process.wait(60s), 2) << arguments[0];
    const std::string err = process.err();
    EXPECT_NE(err.find(complaint), std::string::npos) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  };
  for (const char* url : {"memq://", "udpm://elsewhere:7667", "udpm://239.255.76.67", "udpm://10.0.0.1:7667",
                          "http://a", "udpm://239.255.76.67:99999", "udpm://239.255.76.67:7667?tll=0",
                          "udpm://239.255.76.67:7667?ttl=x", ""})
    refuses({"estimator", "harmonic", "--bus", url}, "--bus");
  refuses({"estimator", "nobodys", "--bus", bus_url()}, "nobodys");
  refuses({"estimator", "harmonic", "--lag-s", "2", "--bus", bus_url()}, "expected no lag");
  refuses({"acquisition", campaign, "--serial", path("none"), "--bus", bus_url()}, "none");
  refuses({"acquisition", campaign, "--serial", campaign, "--bus", bus_url()}, "short.toml");
  refuses({"rig-sim", campaign, "--run", "T1", "--bus", bus_url()}, kRun);
  refuses({"motion", campaign, "--run", kRun, "--drive", "tcp://127.0.0.1:1", "--bus", bus_url()},
          "127.0.0.1:1");
  refuses({"motion", campaign, "--run", kRun, "--drive", "can0", "--bus", bus_url()}, "--drive can0");
  refuses({"motion", campaign, "--run", kRun, "--drive", "rtu:" + path("none"), "--bus", bus_url()}, "none");
  refuses({"recorder", "--out", path("no/such/place.lcm"), "--bus", bus_url()}, "no/such/place.lcm");
  refuses({"recorder", "--out", campaign, "--bus", bus_url()}, "is there already");
  std::filesystem::create_directories(path("swept.partial/runs"));
  temporary_.write("swept.partial/runs/first.lcm", "a run that is done");
  refuses({"evaluator", "--run", kRun, "--out", path("swept"), "--bus", bus_url()}, "swept.partial holds runs");
  EXPECT_TRUE(std::filesystem::exists(path("swept.partial/runs/first.lcm")));
}

TEST_F(Laboratory, MissingMulticastRouteIsOneSentenceAndExitTwo) {
  Process possible(temporary_, "possible", {"/usr/bin/unshare", "-rn", "/bin/true"});
  if (possible.wait(30s) != 0) GTEST_SKIP() << "this user may not make a network namespace";
  Process process(temporary_, "alone",
                  {"/usr/bin/unshare", "-rn", WAVERIG_PROGRAM, "node", "estimator", "harmonic"});
  EXPECT_EQ(process.wait(60s), 2);
  EXPECT_NE(process.err().find("multicast route"), std::string::npos) << process.err();
}

}  // namespace
}  // namespace waverig
