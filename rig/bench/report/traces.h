// Traces: what the unit's counts and thermometer did over a run, from the frames kept now and then.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "rig/bench/sequence.h"
#include "rig/bench/store.h"

namespace waverig::rig::bench {

class Traces {
 public:
  explicit Traces(const UnitDescription& unit, const FrameLayout& counts_layout);

  void add(const TraceRow& row);  // in the order of time; rows of other ports are passed over

  // Since 1970. A current is the mean since the frame before, by design's scale factors; NaN after a restart.
  const std::vector<double>& time_s() const { return time_s_; }
  const std::vector<double>& temperature_degC() const { return temperature_degC_; }
  const std::vector<double>& current_A(const std::string& channel) const { return current_A_.at(channel); }

 private:
  UnitDescription unit_;
  FrameLayout layout_;
  std::size_t ticks_, temperature_;
  std::vector<std::int64_t> last_;
  std::vector<double> time_s_, temperature_degC_;
  std::map<std::string, std::vector<double>> current_A_;
};

Traces traces_of(const Sequence& sequence, const Store& store);

}  // namespace waverig::rig::bench
