// PortReader: one serial port of the unit, from bytes to checked frames to recordings. It never pauses: the
// reactor serves it during every wait.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rig/acquisition/serial_port.h"
#include "rig/bench/laboratory.h"
#include "rig/bench/reactor.h"
#include "rig/bench/store.h"
#include "rig/frontend/frame_codec.h"

namespace waverig::rig::bench {

// How far a running total has come from one frame to another; it may have wrapped once.
std::int64_t total_step(const FrameLayout& layout, const std::vector<std::int64_t>& from,
                        const std::vector<std::int64_t>& to, std::size_t field);

class PortReader {
 public:
  // Throws UserError where the port cannot be opened.
  PortReader(Reactor& reactor, const Port& port, const UnitDescription& unit);
  ~PortReader();
  PortReader(const PortReader&) = delete;
  PortReader& operator=(const PortReader&) = delete;

  void write(const std::string& line);  // a command to the unit; throws InstrumentError

  // Begins a recording: with the next frame, or (join) with the last one there was.
  void begin(const std::vector<std::string>& channels, double duration_s, bool join, bool keep);
  bool complete() const { return recording_ && recording_->complete; }
  bool begun() const { return recording_ && !recording_->first.empty(); }
  RecordingRow finish();  // of what there is; the recording is over
  void give_up() { recording_.reset(); }

  const std::vector<std::int64_t>& last_frame() const { return last_; }  // empty: none yet
  void set_last_frame(std::vector<std::int64_t> frame) { last_ = std::move(frame); }

  // Sees every frame, e.g. for a live view.
  std::function<void(const std::vector<std::int64_t>& raw)> on_frame;
  const Port& port() const { return port_; }
  const FrameStatistics& statistics() const { return decoder_.statistics(); }

 private:
  struct Recording {
    std::vector<std::string> channels;
    std::vector<std::size_t> fields;  // N and P of each
    std::int64_t duration_ticks = 0;
    bool keep = false, complete = false;
    std::int64_t start_utime = 0, frames = 0, broken_before = 0;
    std::vector<std::int64_t> first, last;  // raw frames
    double temperature_sum = 0, temperature_low = 0, temperature_high = 0;
    std::vector<std::vector<std::int32_t>> kept;  // columns: ticks, then fields; increments
    std::vector<std::int64_t> second;             // the frame that began the present second, for the noise
    std::vector<std::vector<double>> second_A;    // by channel
  };
  void read();
  void add(const std::vector<std::int64_t>& raw);
  void start(const std::vector<std::int64_t>& raw);
  std::int64_t step(const std::vector<std::int64_t>& from, const std::vector<std::int64_t>& to,
                    std::size_t field) const {
    return total_step(port_.layout, from, to, field);
  }
  double temperature(const std::vector<std::int64_t>& raw) const;
  void end_second(const std::vector<std::int64_t>& raw);

  Reactor& reactor_;
  const Port& port_;
  const UnitDescription& unit_;
  SerialPort serial_;
  std::int64_t cable_;
  FrameDecoder decoder_;
  std::vector<std::int64_t> last_;
  std::optional<Recording> recording_;
  std::size_t ticks_, temperature_, counter_;
  std::optional<std::size_t> clock_, reference_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace waverig::rig::bench
