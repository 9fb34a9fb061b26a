// The nodes of the laboratory, each a process of its own: what the command line tells them, and what they do
// until they end. Each returns the exit status.
#pragma once
#include <optional>
#include <string>

namespace waverig::cli {

struct RigSimArguments {
  std::string campaign, run, bus, serial_link;
  int port = 5020;
  double speed = 1, watchdog_ms = 100;
};
int run_rig_sim(const RigSimArguments& arguments);

struct MotionArguments {
  std::string campaign, run, bus, drive;
  double speed = 1, max_cycle_gap_ms = 50, max_following_error_deg = 1.15, response_timeout_ms = 20;
  bool tells_truth = false;
};
int run_motion(const MotionArguments& arguments);

struct AcquisitionArguments {
  std::string campaign, bus, serial, calibration;
  int baud = 115200;
};
int run_acquisition(const AcquisitionArguments& arguments);

struct EstimatorArguments {
  std::string method, bus, campaign, calibration;
  double lag_s = 0;
  bool one_record = false;
};
int run_estimator(const EstimatorArguments& arguments);

struct EvaluatorArguments {
  std::string run, bus, campaign, out;
  bool replace = false;
  double quiet_s = 5;
};
int run_evaluator(const EvaluatorArguments& arguments);

struct RecorderArguments {
  std::string bus, out;
  bool one_record = false, replace = false;
  double quiet_s = 5;
};
int run_recorder(const RecorderArguments& arguments);

struct InstrumentsSimArguments {
  std::string laboratory, simulation, write;
};
int run_instruments_sim(const InstrumentsSimArguments& arguments);

}  // namespace waverig::cli
