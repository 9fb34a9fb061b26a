#include "rig/nodes/evaluator_node.h"

#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>

#include "estimator/messages.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/flags.h"

namespace waverig::rig {
namespace {

// What a method may be called, so that its name can stand in a table and in a file's name.
constexpr const char* kMethodName = "[A-Za-z0-9_.-]+";

// handler(method, message) for every well-formed message on PREFIX<method>.
template <class Message, class Handler>
void subscribe_methods(Bus& bus, std::string_view prefix, Handler handler) {
  bus.subscribe_raw(escaped_channel(prefix) + kMethodName,
                    [prefix, handler](std::string_view channel, const void* data, std::size_t size) {
                      Message message{};
                      const int expected = message.getEncodedSize();
                      if (static_cast<int>(size) == expected && message.decode(data, 0, expected) == expected)
                        handler(channel.substr(prefix.size()), message);
                    });
}

}  // namespace

EvaluatorNode::EvaluatorNode(Bus& bus, std::string run, const evaluation::JudgeSettings& settings)
    : judge_(std::move(run), settings) {
  bus.subscribe<run_t>(channel::kRun, [this](const run_t& m) { judge_.add(m); });
  bus.subscribe<truth_t>(channel::kTruth, [this](const truth_t& m) {
    truths_.missing_before(m.seq);
    judge_.add(m);
  });
  subscribe_methods<heave_t>(bus, channel::kHeavePrefix, [this](std::string_view method, const heave_t& m) {
    judge_.add(method, estimator::heave_of(m));
  });
  subscribe_methods<wave_t>(bus, channel::kWavePrefix, [this](std::string_view method, const wave_t& m) {
    waves_.try_emplace(std::string(method)).first->second.missing_before(m.seq);
    judge_.add(method, estimator::wave_of(m));
  });
  subscribe_methods<sea_t>(bus, channel::kSeaPrefix, [this](std::string_view method, const sea_t& m) {
    judge_.add(method, estimator::sea_of(m));
  });
}

std::vector<evaluation::RunResult> EvaluatorNode::finish() {
  std::vector<evaluation::RunResult> results = judge_.finish();
  for (evaluation::RunResult& result : results) {
    const auto waves = waves_.find(result.method);
    if (waves != waves_.end() && waves->second.missing() > 0) result.statistics.flags |= flag::kGap;
  }
  return results;
}

}  // namespace waverig::rig
