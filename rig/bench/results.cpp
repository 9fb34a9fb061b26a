#include "rig/bench/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>

namespace waverig::rig::bench {
namespace {

constexpr double kLargestOffDesign = 0.1;  // no converter that works is further
constexpr double kStep_degC = 1;           // between the temperatures that are looked at

template <class Value>
double largest(const estimator::TemperatureLaw& over, Value&& value) {
  double most = 0;
  for (double T = over.from_degC; T < over.to_degC; T += kStep_degC) most = std::max(most, value(T));
  return std::max(most, value(over.to_degC));
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

const ChannelAnalysis* analysis_of(const Analysis& analysis, const std::string& channel) {
  for (const ChannelAnalysis& c : analysis.channels)
    if (c.channel == channel) return &c;
  return nullptr;
}

// What the law says at its reference temperature: value, k = 2, slope.
std::string law_columns(const estimator::TemperatureLaw& law, double factor) {
  const auto c = [&](Eigen::Index i) {
    return law.coefficients.size() > i ? factor * law.coefficients[i] : 0.0;
  };
  return fmt::format("{:.6g},{:.4g},{:.6g},{}", c(0), 2 * factor * law.sigma_at(law.reference_degC), c(1),
                     law.order());
}

struct Suite {
  Suite(pugi::xml_node parent, const char* name) : node(parent.append_child("testsuite")) {
    node.append_attribute("name") = name;
  }
  pugi::xml_node add(const std::string& group, const std::string& name) {
    ++tests;
    pugi::xml_node test = node.append_child("testcase");
    test.append_attribute("classname") = group.c_str();
    test.append_attribute("name") = name.c_str();
    return test;
  }
  void fail(pugi::xml_node test, const std::string& message) {
    ++failures;
    test.append_child("failure").append_attribute("message") = message.c_str();
  }
  void close() {
    node.append_attribute("tests") = tests;
    node.append_attribute("failures") = failures;
  }
  pugi::xml_node node;
  int tests = 0, failures = 0;
};

}  // namespace

std::string shown(double value, const std::string& base) {
  return base == "1" ? fmt::format("{:.3g} ppm", 1e6 * value) : fmt::format("{:.3g} nA", 1e9 * value);
}

double scale_expanded(const estimator::FrontEndChannel& channel) {
  return largest(channel.dsf_N, [&](double T) {
    return 2 * std::max(channel.dsf_N.sigma_at(T), channel.dsf_P.sigma_at(T));
  });
}

double scale_off_design(const estimator::FrontEndChannel& channel) {
  return largest(channel.dsf_N, [&](double T) {
    return std::max(std::abs(channel.dsf_N.at(T)), std::abs(channel.dsf_P.at(T)));
  });
}

double bias_expanded_A(const estimator::FrontEndChannel& channel) {
  return largest(channel.bias_A, [&](double T) { return channel.bias_expanded_A(T); });
}

std::vector<Verdict> hold_against_limits(const Sequence& sequence, const Analysis& analysis) {
  std::vector<Verdict> verdicts;
  for (const ChannelAnalysis& measured : analysis.channels) {
    const UnitDescription::Channel& design = *sequence.laboratory.unit.channel(measured.channel);
    const estimator::FrontEndChannel& channel = analysis.calibration.channel(measured.channel);
    if (!measured.scale_factors.empty()) {
      verdicts.push_back(
          {measured.channel, "scale factor", scale_expanded(channel), design.scale_limit, "1"});
      // Small uncertainty of what cannot be: the laboratory file describes another unit than the one there.
      if (const double off = scale_off_design(channel); off > kLargestOffDesign)
        verdicts.push_back({measured.channel, "off its design", off, kLargestOffDesign, "1"});
    }
    if (measured.bias)
      verdicts.push_back({measured.channel, "bias", bias_expanded_A(channel), design.bias_limit_A, "A"});
  }
  return verdicts;
}

std::string table_of(const std::vector<Verdict>& verdicts) {
  std::string text =
      fmt::format("{:<10} {:<14} {:>14} {:>12}\n", "channel", "quantity", "U (k = 2)", "limit");
  for (const Verdict& v : verdicts)
    text += fmt::format("{:<10} {:<14} {:>14} {:>12}  {}\n", v.channel, v.quantity, shown(v.value, v.base),
                        shown(v.limit, v.base), v.passed() ? "" : "exceeded");
  return text;
}

std::string channels_csv(const Analysis& analysis) {
  std::string text =
      "channel,K_N0_C,dsf_N_ppm,dsf_N_U_ppm,dsf_N_ppm_per_degC,dsf_N_order,K_P0_C,dsf_P_ppm,dsf_P_U_ppm,"
      "dsf_P_ppm_per_degC,dsf_P_order,bias_nA,bias_U_nA,bias_nA_per_degC,bias_order,hysteresis_nA,"
      "reference_degC,from_degC,to_degC,scale_largest_U_ppm,bias_largest_U_nA\n";
  for (const estimator::FrontEndChannel& c : analysis.calibration.channels) {
    const ChannelAnalysis* measured = analysis_of(analysis, c.name);
    const bool bias = measured != nullptr && measured->bias.has_value();
    const bool scale =
        c.dsf_N.covariance(0, 0) > 0;  // measured now, or taken over from an earlier calibration
    const estimator::TemperatureLaw& over = bias ? c.bias_A : c.dsf_N;
    text += fmt::format("{},{:.9g},{},{:.9g},{},{},{},{:g},{:.3g},{:.3g},{},{}\n", c.name, c.K_N0_C,
                        scale ? law_columns(c.dsf_N, 1e6) : ",,,", c.K_P0_C,
                        scale ? law_columns(c.dsf_P, 1e6) : ",,,", bias ? law_columns(c.bias_A, 1e9) : ",,,",
                        bias ? fmt::format("{:.4g}", 1e9 * measured->bias->hysteresis_A) : "",
                        over.reference_degC, over.from_degC, over.to_degC,
                        scale ? fmt::format("{:.4g}", 1e6 * scale_expanded(c)) : "",
                        bias ? fmt::format("{:.4g}", 1e9 * bias_expanded_A(c)) : "");
  }
  return text;
}

std::string steps_csv(const Store& store) {
  std::string text = "index,attempt,section,path,step,place,outcome,started,ended,value_si,limits,message\n";
  for (const StepRow& s : store.steps())
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", s.index, s.attempt, s.section,
                        quoted(s.path), quoted(s.what), quoted(s.where), name_of(s.outcome),
                        iso_time(s.started_utime), iso_time(s.ended_utime),
                        s.value ? fmt::format("{:.9g}", *s.value) : "", quoted(s.limits), quoted(s.message));
  return text;
}

std::string junit_xml(const Sequence& sequence, const Store& store, const std::vector<Verdict>& verdicts) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("testsuites");
  root.append_attribute("name") = sequence.title.c_str();

  Suite channels(root, "channels");
  for (const Verdict& v : verdicts) {
    pugi::xml_node test = channels.add(v.channel, v.quantity);
    const std::string said = fmt::format("expanded uncertainty (k = 2) {}: expected at most {}",
                                         shown(v.value, v.base), shown(v.limit, v.base));
    if (!v.passed()) channels.fail(test, said);
    test.append_child("system-out").text() = said.c_str();
  }
  channels.close();

  // Of several attempts the last one counts.
  std::map<int, StepRow> last;
  for (StepRow& s : store.steps()) last.insert_or_assign(s.index, std::move(s));
  Suite steps(root, "steps");
  for (const auto& [index, s] : last) {
    const bool failed = s.outcome == StepOutcome::kFailed || s.outcome == StepOutcome::kAccepted;
    if (s.limits.empty() && !failed) continue;
    pugi::xml_node test = steps.add(s.path.empty() ? s.section : s.path, fmt::format("{} {}", index, s.what));
    test.append_attribute("time") =
        fmt::format("{:.3f}", 1e-6 * static_cast<double>(s.ended_utime - s.started_utime)).c_str();
    if (failed) steps.fail(test, s.message);
    if (!s.limits.empty()) test.append_child("system-out").text() = s.limits.c_str();
  }
  const std::string outcome = store.info().outcome;
  pugi::xml_node run = steps.add("run", "outcome");
  if (outcome != "done") steps.fail(run, outcome);
  steps.close();

  std::ostringstream out;
  document.save(out, " ");
  return out.str();
}

}  // namespace waverig::rig::bench
