// waverig node: the nodes of the laboratory on the command line.
#include <CLI/CLI.hpp>
#include <memory>

#include "rig/cli/commands.h"
#include "rig/cli/nodes/addresses.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/cli/number_checks.h"

namespace waverig::cli {
namespace {

constexpr const char* kSession =
    R"(Each node is a process of its own; they meet on the bus, in real time. The others first, motion last.
Each ends well on SIGINT, SIGTERM and SIGHUP.
Example: a whole session on the simulated rig, calibration.json from a sweep of the campaign:

  RUN=T06.00s_H060.0cm_r1
  waverig node rig-sim rig/default.toml --run $RUN --serial-link /tmp/sensor & sleep 2
  CALIBRATION="--calibration results/default/calibration.json"
  waverig node acquisition rig/default.toml --serial /tmp/sensor $CALIBRATION &
  waverig node estimator harmonic --campaign rig/default.toml $CALIBRATION --one-record &
  waverig node estimator lee2014 --campaign rig/default.toml $CALIBRATION --one-record &
  waverig node recorder --out $RUN.lcm --one-record &
  waverig node evaluator --campaign rig/default.toml --run $RUN --out results/$RUN & sleep 2
  waverig node motion rig/default.toml --run $RUN --drive tcp://127.0.0.1:5020
  wait %3 %4 %5 %6; kill %2; wait %2; kill %1

With a real rig, leave out rig-sim; give motion its drive (rtu:/dev/ttyUSB0) and --tell-truth, acquisition its
serial port.
A method of your own is any program that publishes heave_t on WAVERIG_HEAVE_<name>.)";

// A node's subcommand with what all nodes have; run is called with the arguments when it is chosen.
template <class Arguments>
CLI::App* add(CLI::App& nodes, const char* name, const char* what, Command& chosen,
              const std::shared_ptr<Arguments>& arguments, int (*run)(const Arguments&)) {
  CLI::App* command = nodes.add_subcommand(name, what);
  arguments->bus = kDefaultBus;
  command->add_option("--bus", arguments->bus, "LCM address; other jobs need a port of their own")
      ->capture_default_str();
  command->callback([arguments, run, &chosen] { chosen = [arguments, run] { return run(*arguments); }; });
  return command;
}

void add_campaign_and_run(CLI::App& command, std::string& campaign, std::string& run) {
  command.add_option("campaign", campaign, "Campaign file (TOML)")->required();
  command.add_option("--run", run, "Name of the run, e.g. T06.00s_H060.0cm_r1")->required();
}

void add_speed(CLI::App& command, double& speed) {
  command
      .add_option("--speed", speed, "Of the rig's time against real time; the same for rig-sim and motion")
      ->check(between(0.01, 100.0))
      ->capture_default_str();
}

void add_rig_sim(CLI::App& nodes, Command& chosen) {
  auto a = std::make_shared<RigSimArguments>();
  CLI::App* command =
      add(nodes, "rig-sim", "The simulated rig: a drive on Modbus TCP, frames on a serial line, the truth",
          chosen, a, run_rig_sim);
  add_campaign_and_run(*command, a->campaign, a->run);
  command->add_option("--port", a->port, "TCP port of the drive; 0: any free one, which it prints")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--serial-link", a->serial_link,
                      "A name for the serial line, beside the one it prints");
  command
      ->add_option("--watchdog-ms", a->watchdog_ms,
                   "The drive stops when it hears nothing for so long, in the rig's time")
      ->check(between(20.0, 10000.0))
      ->capture_default_str();
  add_speed(*command, a->speed);
  command->footer(
      "Examples:\n"
      "  waverig node rig-sim rig/default.toml --run T06.00s_H060.0cm_r1 --serial-link /tmp/sensor\n"
      "  waverig node rig-sim rig/default.toml --run T12.00s_H100.0cm_r2 --port 0 --speed 0.5");
}

void add_motion(CLI::App& nodes, Command& chosen) {
  auto a = std::make_shared<MotionArguments>();
  CLI::App* command =
      add(nodes, "motion", "One run of the arm through its drive; SIGUSR1 holds it, SIGUSR2 lets it go on",
          chosen, a, run_motion);
  add_campaign_and_run(*command, a->campaign, a->run);
  command->add_option("--drive", a->drive, "tcp://ADDRESS:PORT or rtu:DEVICE (Modbus)")->required();
  command
      ->add_option("--max-cycle-gap-ms", a->max_cycle_gap_ms,
                   "Alarm where two control cycles are further apart")
      ->check(between(10.0, 10000.0))
      ->capture_default_str();
  command
      ->add_option("--max-following-error-deg", a->max_following_error_deg,
                   "Alarm where the arm is further from its setpoint")
      ->check(between(0.01, 45.0))
      ->capture_default_str();
  command
      ->add_option("--response-timeout-ms", a->response_timeout_ms, "How long the drive may take to answer")
      ->check(between(1.0, 5000.0))
      ->capture_default_str();
  command->add_flag("--tell-truth", a->tells_truth,
                    "Publish where the encoder says that the arm's tip is as the truth: on a real rig; the "
                    "simulated one tells its own");
  add_speed(*command, a->speed);
  command->footer(
      "Exit status 1 where an alarm or a signal stopped the run before its end.\n"
      "Examples:\n"
      "  waverig node motion rig/default.toml --run T06.00s_H060.0cm_r1 --drive tcp://127.0.0.1:5020\n"
      "  waverig node motion rig/default.toml --run T06.00s_H060.0cm_r1 --drive rtu:/dev/ttyUSB0 "
      "--tell-truth");
}

void add_acquisition(CLI::App& nodes, Command& chosen) {
  auto a = std::make_shared<AcquisitionArguments>();
  CLI::App* command = add(nodes, "acquisition", "Frames from a serial line to counts and calibrated samples",
                          chosen, a, run_acquisition);
  command->add_option("campaign", a->campaign, "Campaign file (TOML): which sensor")->required();
  command->add_option("--serial", a->serial, "Serial port or pseudo-terminal")->required();
  command->add_option("--baud", a->baud, "Of the serial port")->capture_default_str();
  command->add_option("--calibration", a->calibration,
                      "calibration.json; without it samples are flagged as uncalibrated");
  command->footer(
      "Examples:\n"
      "  waverig node acquisition rig/default.toml --serial /tmp/sensor --calibration "
      "results/default/calibration.json\n"
      "  waverig node acquisition rig/default.toml --serial /dev/ttyUSB1 --baud 230400");
}

void add_estimator(CLI::App& nodes, Command& chosen) {
  auto a = std::make_shared<EstimatorArguments>();
  CLI::App* command =
      add(nodes, "estimator", "One method, from samples to heave and waves", chosen, a, run_estimator);
  command->add_option("method", a->method, "Name of the method, e.g. harmonic")->required();
  command->add_option("--campaign", a->campaign, "For what is known of sensor and place");
  command->add_option(
      "--calibration", a->calibration,
      "calibration.json, for what it says of its own uncertainty; without it a default sensor's "
      "is taken");
  command->add_option("--lag-s", a->lag_s, "realtime: tell heave so much later, by what came meanwhile")
      ->check(not_negative());
  command->add_flag("--one-record", a->one_record, "End after one record");
  command->footer(
      "Examples:\n"
      "  waverig node estimator harmonic --campaign rig/default.toml --calibration "
      "results/default/calibration.json --one-record\n"
      "  waverig node estimator realtime --calibration results/default/calibration.json --lag-s 2");
}

void add_evaluator(CLI::App& nodes, Command& chosen) {
  auto a = std::make_shared<EvaluatorArguments>();
  CLI::App* command = add(nodes, "evaluator", "Judges every method it hears against the truth of one run",
                          chosen, a, run_evaluator);
  command->add_option("--run", a->run, "Name of the run")->required();
  command->add_option("--out", a->out, "Results directory, made anew when the run has ended well")
      ->required();
  command->add_option("--campaign", a->campaign, "For the sensor's noise, and to be kept with the results");
  command->add_flag("--replace", a->replace, "Replace results that are there");
  command
      ->add_option("--quiet-s", a->quiet_s,
                   "Ends when no estimate came for so long after the end of the record")
      ->check(between(0.1, 60.0))
      ->capture_default_str();
  command->footer(
      "Exit status 1 where the run was stopped, or nothing was heard.\n"
      "Example:\n"
      "  waverig node evaluator --campaign rig/default.toml --run T06.00s_H060.0cm_r1 --out results/T06");
}

void add_recorder(CLI::App& nodes, Command& chosen) {
  auto a = std::make_shared<RecorderArguments>();
  CLI::App* command =
      add(nodes, "recorder", "Everything on the bus into an LCM event log", chosen, a, run_recorder);
  command->add_option("--out", a->out, "The log; FILE.part until it is whole")->required();
  command->add_flag("--one-record", a->one_record, "End after one record");
  command->add_flag("--replace", a->replace, "Replace a log that is there");
  command
      ->add_option("--quiet-s", a->quiet_s,
                   "With --one-record: ends when no estimate came for so long after its end")
      ->check(between(0.1, 60.0))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  waverig node recorder --out T06.lcm --one-record\n"
      "  waverig node recorder --out session.lcm --replace");
}

// Not on the bus: instruments have cables of their own.
void add_instruments_sim(CLI::App& nodes, Command& chosen) {
  auto a = std::make_shared<InstrumentsSimArguments>();
  CLI::App* command = nodes.add_subcommand(
      "instruments-sim",
      "The calibration bench's instruments, simulated: raw SCPI, VXI-11, GPIB gateway, serial ports");
  command
      ->add_option("laboratory", a->laboratory, "Laboratory file (TOML), e.g. rig/sequences/laboratory.toml")
      ->required();
  command->add_option("--simulation", a->simulation,
                      "Which units and instruments, and what goes wrong (TOML)");
  command->add_option("--write", a->write,
                      "Write the laboratory file with the addresses of the simulated instruments");
  command->footer(
      "Prints every way to every instrument and serves until SIGINT, SIGTERM or SIGHUP.\n"
      "Example:\n"
      "  waverig node instruments-sim rig/sequences/laboratory.toml &\n"
      "  lxi scpi --address 127.0.0.1 --port PORT --raw '*IDN?'\n"
      "  sigrok-cli --driver scpi-dmm:conn=tcp-raw/127.0.0.1/PORT --samples 3");
  command->callback([a, &chosen] { chosen = [a] { return run_instruments_sim(*a); }; });
}

}  // namespace

void add_node(CLI::App& app, Command& chosen) {
  CLI::App* nodes =
      app.add_subcommand("node", "One node of the laboratory, in real time on a bus of many processes");
  nodes->require_subcommand(1);
  add_rig_sim(*nodes, chosen);
  add_motion(*nodes, chosen);
  add_acquisition(*nodes, chosen);
  add_estimator(*nodes, chosen);
  add_evaluator(*nodes, chosen);
  add_recorder(*nodes, chosen);
  add_instruments_sim(*nodes, chosen);
  nodes->footer(kSession);  // last, or each node's help would end with it too
}

}  // namespace waverig::cli
