#include "rig/bench/analysis.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

using estimator::FrontEndChannel;
using estimator::FrontEndReading;

// Only recordings of steps that are done, each once.
std::vector<RecordingRow> good_recordings(const Store& store) {
  std::set<std::pair<int, int>> good;
  for (const StepRow& step : store.steps())
    if (step.outcome == StepOutcome::kDone || step.outcome == StepOutcome::kAccepted)
      good.emplace(step.index, step.attempt);
  std::vector<RecordingRow> rows = store.recordings();
  std::erase_if(rows, [&](const RecordingRow& r) { return !good.contains({r.index, r.attempt}); });
  return rows;
}

double tag_si(const RecordingRow& row, const std::string& tag, const std::string& base) {
  const auto found = row.tags.find(tag);
  const std::string where = fmt::format("recording of step {}: tags.{}", row.index, tag);
  if (found == row.tags.end()) throw UserError(where + " is missing: expected it in the sequence file");
  return parse_quantity(found->second, base, where).si;
}

struct Rates {
  double N_Hz, P_Hz;
};

Rates rates_of(const RecordingRow& row, const ChannelCounts& counts, const UnitDescription& unit) {
  const double nominal_s = static_cast<double>(row.ticks) * unit.tick_s;
  const double ratio = static_cast<double>(row.clock) / (unit.clock_Hz * nominal_s);
  return {estimator::count_rate_Hz(static_cast<double>(counts.N), nominal_s, ratio),
          estimator::count_rate_Hz(static_cast<double>(counts.P), nominal_s, ratio)};
}

FrontEndChannel by_design(const UnitDescription::Channel& design) {
  FrontEndChannel channel;
  channel.name = design.name;
  channel.K_N0_C = design.K_N0_C;
  channel.K_P0_C = design.K_P0_C;
  return channel;
}

// What the DMM read of one setting of one channel, in the place of the unit.
struct MeterReadings {
  double range_A = 0, sum_A = 0;
  int count = 0;
};

std::string setting_of(const std::map<std::string, std::string>& tags, const std::string& where) {
  std::string setting;
  for (const char* tag : {"temperature", "channel", "setting"}) {
    if (!tags.contains(tag))
      throw UserError(fmt::format("{}: tags.{} is missing: expected it in the sequence file", where, tag));
    setting += tags.at(tag) + ", ";
  }
  return setting;
}

// By the setting that the reading's step names in its tags.
std::map<std::string, MeterReadings> meter_readings(const Sequence& sequence, const Store& store) {
  std::map<std::string, MeterReadings> readings;
  for (const StepRow& row : store.steps()) {
    const auto& tags = sequence.plan.at(static_cast<std::size_t>(row.index)).tags;
    if (row.outcome != StepOutcome::kDone || !row.value || !tags.contains("meter_range")) continue;
    MeterReadings& of_setting = readings[setting_of(tags, row.where)];
    of_setting.range_A = parse_quantity(tags.at("meter_range"), "A", row.where + ": tags.meter_range").si;
    of_setting.sum_A += *row.value;
    ++of_setting.count;
  }
  return readings;
}

// By the DMM where meter is given (Kim, eqs. 12-18), else by the calibrator (eqs. 4-11).
void analyse_scale_factors(const Sequence& sequence, const std::vector<RecordingRow>& rows,
                           const std::map<std::string, MeterReadings>* meter, Analysis& analysis) {
  const UnitDescription& unit = sequence.laboratory.unit;
  struct Group {
    std::vector<FrontEndReading> readings;
    double temperature_sum = 0;
  };
  std::map<std::string, std::map<double, Group>> groups;  // by channel and chamber temperature
  for (const RecordingRow& row : rows) {
    if (row.channels.size() != 1) continue;
    const ChannelCounts& counts = row.channels.front();
    Group& group = groups[counts.channel][tag_si(row, "temperature", "degC")];
    const Rates rates = rates_of(row, counts, unit);
    FrontEndReading reading;
    reading.level_A = tag_si(row, "level", "A");
    reading.range_A = tag_si(row, "range", "A");
    reading.polarity = static_cast<int>(tag_si(row, "polarity", "1"));
    reading.rate_N_Hz = rates.N_Hz;
    reading.rate_P_Hz = rates.P_Hz;
    reading.duration_s = static_cast<double>(row.ticks) * unit.tick_s;
    if (meter != nullptr) {
      const auto found = meter->find(setting_of(row.tags, fmt::format("recording of step {}", row.index)));
      if (found != meter->end()) {  // where a level has none, the method refuses it
        reading.dmm_A = found->second.sum_A / found->second.count;
        reading.dmm_range_A = found->second.range_A;
      }
    }
    group.readings.push_back(reading);
    group.temperature_sum += row.temperature;
  }
  for (const UnitDescription::Channel& design : unit.channels) {
    const auto found = groups.find(design.name);
    if (found == groups.end()) continue;
    estimator::ScaleFactorKnowledge knowledge;
    knowledge.noise_A_sqrt_s = design.noise_A_sqrt_s;
    knowledge.bias_wander_A = design.bias_wander_A;
    FrontEndChannel channel = by_design(design);
    ChannelAnalysis& result = analysis.channels.emplace_back();
    result.channel = design.name;
    for (const auto& [temperature, group] : found->second) {
      try {
        result.scale_factors.push_back(
            {group.temperature_sum / static_cast<double>(group.readings.size()),
             meter != nullptr ? estimator::scale_factors_by_dmm(group.readings, knowledge)
                              : estimator::scale_factors_by_calibrator(group.readings, knowledge)});
      } catch (const UserError& error) {
        throw UserError(fmt::format("{} at {} degC: {}", design.name, temperature, error.what()));
      }
    }
    estimator::fit_scale_factor_laws(result.scale_factors, channel);
    analysis.calibration.channels.push_back(std::move(channel));
  }
  if (analysis.channels.empty())
    throw UserError(sequence.file.string() + ": the run has no recording of a single channel");
}

void analyse_bias(const Sequence& sequence, const std::vector<RecordingRow>& rows,
                  const estimator::FrontEndCalibration* known, Analysis& analysis) {
  const UnitDescription& unit = sequence.laboratory.unit;
  std::map<std::string, std::vector<estimator::BiasReading>> readings;
  std::vector<estimator::OscillatorReading> oscillator;
  for (const RecordingRow& row : rows) {
    const double nominal_s = static_cast<double>(row.ticks) * unit.tick_s;
    if (row.port == unit.monitor_port)
      oscillator.push_back(
          {row.temperature, static_cast<double>(row.reference), unit.reference_Hz, nominal_s});
    for (const ChannelCounts& counts : row.channels) {
      const Rates rates = rates_of(row, counts, unit);
      readings[counts.channel].push_back({row.temperature, rates.N_Hz, rates.P_Hz, nominal_s});
    }
  }
  for (const UnitDescription::Channel& design : unit.channels) {
    const auto found = readings.find(design.name);
    if (found == readings.end()) continue;
    FrontEndChannel channel = known != nullptr ? known->channel(design.name) : by_design(design);
    ChannelAnalysis& result = analysis.channels.emplace_back();
    result.channel = design.name;
    result.bias = estimator::fit_bias(found->second, channel);
    channel.bias_A = result.bias->law;
    channel.bias_loop = result.bias->half_loop;
    channel.bias_budget = result.bias->budget;
    analysis.calibration.channels.push_back(std::move(channel));
  }
  if (analysis.channels.empty())
    throw UserError(sequence.file.string() + ": the run has no recording of channels");
  analysis.oscillator = estimator::fit_oscillator(oscillator);
  analysis.calibration.oscillator = analysis.oscillator.law;
  analysis.calibration.oscillator_budget = analysis.oscillator.budget;
}

}  // namespace

std::string iso_time(std::int64_t utime) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(utime / 1'000'000)));
}

Analysis analyse(const Sequence& sequence, const Store& store, const estimator::FrontEndCalibration* known) {
  const RunInfo info = store.info();
  Analysis analysis;
  estimator::FrontEndCalibration& calibration = analysis.calibration;
  calibration.procedure = sequence.procedure;
  calibration.measured = iso_time(info.started_utime);
  calibration.unit = sequence.laboratory.unit.name + ", " + sequence.laboratory.unit.serial;
  calibration.id = fmt::format("{}-{}-{:%Y%m%dT%H%M%S}", sequence.laboratory.unit.serial, sequence.procedure,
                               fmt::gmtime(static_cast<std::time_t>(info.started_utime / 1'000'000)));
  calibration.version = info.version;
  for (const auto& [name, identity] : info.instruments)
    calibration.instruments.push_back(name + ": " + identity);
  for (const auto& [name, print] : info.files) calibration.files.push_back(name + ": " + print);
  const std::vector<RecordingRow> rows = good_recordings(store);
  if (sequence.procedure == "scale_factor") analyse_scale_factors(sequence, rows, nullptr, analysis);
  if (sequence.procedure == "scale_factor_dmm") {
    const std::map<std::string, MeterReadings> meter = meter_readings(sequence, store);
    analyse_scale_factors(sequence, rows, &meter, analysis);
  }
  if (sequence.procedure == "bias") analyse_bias(sequence, rows, known, analysis);
  return analysis;
}

}  // namespace waverig::rig::bench
