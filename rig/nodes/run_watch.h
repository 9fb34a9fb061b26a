// RunWatch: hears where a run stands: begun, ended, and how. For nodes that end with it.
#pragma once
#include <cstdint>
#include <string>

#include "lcmtypes/bus.h"

namespace waverig::rig {

class RunWatch {
 public:
  explicit RunWatch(Bus& bus);

  bool begun() const { return begun_; }  // a record runs, or has ended
  bool ended() const { return ended_; }  // the first record that was heard
  const std::string& stopped() const {
    return stopped_;
  }  // why the motion stopped before the run's end; empty: it did not
  std::int64_t axis_messages() const {
    return axis_messages_;
  }  // they come all the while the motion node lives
  std::int64_t estimates() const {
    return estimates_;
  }  // heave, waves and sea states of all methods for times in the record

 private:
  bool begun_ = false, ended_ = false;
  std::string stopped_;
  std::int64_t axis_messages_ = 0, estimates_ = 0, end_utime_ = 0;
};

}  // namespace waverig::rig
