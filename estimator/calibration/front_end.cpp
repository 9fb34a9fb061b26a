#include "estimator/calibration/front_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kSchema = "waverig-front-end-1";

Json json_of(const TemperatureLaw& law) {
  Json j;
  j["reference_degC"] = law.reference_degC;
  j["coefficients"] = std::vector<double>(law.coefficients.begin(), law.coefficients.end());
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < law.covariance.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < law.covariance.cols(); ++k) row.push_back(law.covariance(i, k));
    rows.push_back(std::move(row));
  }
  j["covariance"] = std::move(rows);
  j["from_degC"] = law.from_degC;
  j["to_degC"] = law.to_degC;
  return j;
}

Json json_of(const std::vector<BudgetTerm>& budget) {
  Json rows = Json::array();
  for (const BudgetTerm& t : budget)
    rows.push_back({{"name", t.name}, {"sigma", t.sigma}, {"type", std::string(1, t.type)}});
  return rows;
}

// Reads one file with complaints that name the file, the key and what was expected.
class Reader {
 public:
  Reader(const Json& node, std::string name, std::string key = "")
      : node_(node), name_(std::move(name)), key_(std::move(key)) {}

  Reader at(const std::string& key) const {
    if (!node_.is_object() || !node_.contains(key)) refuse(key, "is missing");
    return {node_.at(key), name_, key_.empty() ? key : key_ + "." + key};
  }
  std::vector<Reader> items() const {
    if (!node_.is_array()) refuse("", "expected a list");
    std::vector<Reader> list;
    for (std::size_t i = 0; i < node_.size(); ++i) list.emplace_back(node_[i], name_, fmt::format("{}[{}]", key_, i));
    return list;
  }
  double number() const {
    if (!node_.is_number()) refuse("", "expected a number");
    return node_.get<double>();
  }
  std::string text() const {
    if (!node_.is_string()) refuse("", "expected text");
    return node_.get<std::string>();
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> list;
    for (const Reader& item : items()) list.push_back(item.text());
    return list;
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& why) const {
    const std::string dot = key.empty() || key_.empty() ? "" : ".";
    throw UserError(fmt::format("{}: {}{}{}: {}", name_, key_, dot, key, why));
  }

 private:
  const Json& node_;
  std::string name_, key_;
};

TemperatureLaw law_of(const Reader& r) {
  TemperatureLaw law;
  law.reference_degC = r.at("reference_degC").number();
  law.from_degC = r.at("from_degC").number();
  law.to_degC = r.at("to_degC").number();
  const std::vector<Reader> coefficients = r.at("coefficients").items(), rows = r.at("covariance").items();
  const auto n = static_cast<Eigen::Index>(coefficients.size());
  if (n == 0 || rows.size() != coefficients.size())
    r.refuse("covariance", fmt::format("expected {} rows, one a coefficient, and at least one", n));
  law.coefficients.resize(n);
  law.covariance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    law.coefficients[i] = coefficients[static_cast<std::size_t>(i)].number();
    const std::vector<Reader> row = rows[static_cast<std::size_t>(i)].items();
    if (row.size() != coefficients.size()) r.refuse("covariance", fmt::format("expected {} columns", n));
    for (Eigen::Index k = 0; k < n; ++k) law.covariance(i, k) = row[static_cast<std::size_t>(k)].number();
  }
  return law;
}

std::vector<BudgetTerm> budget_of(const Reader& r) {
  std::vector<BudgetTerm> budget;
  for (const Reader& item : r.items()) {
    const std::string type = item.at("type").text();
    if (type != "A" && type != "B") item.refuse("type", "expected \"A\" or \"B\"");
    budget.push_back({item.at("name").text(), item.at("sigma").number(), type[0]});
  }
  return budget;
}

}  // namespace

double combined_sigma(const std::vector<BudgetTerm>& budget) {
  double sum = 0;
  for (const BudgetTerm& t : budget) sum += t.sigma * t.sigma;
  return std::sqrt(sum);
}

double FrontEndChannel::half_loop_A(double temperature_degC) const {
  if (bias_loop.empty()) return 0;
  const auto above = std::ranges::lower_bound(bias_loop, temperature_degC, {}, &HalfLoop::temperature_degC);
  if (above == bias_loop.begin()) return above->half_A;
  if (above == bias_loop.end()) return bias_loop.back().half_A;
  const HalfLoop &low = *std::prev(above), &high = *above;
  const double part = (temperature_degC - low.temperature_degC) / (high.temperature_degC - low.temperature_degC);
  return std::lerp(low.half_A, high.half_A, part);
}

double FrontEndChannel::bias_expanded_A(double temperature_degC) const {
  const double a = std::abs(half_loop_A(temperature_degC));
  const double sigma = std::max(bias_A.sigma_at(temperature_degC), 1e-15);
  const auto inside = [&](double U) {   // P(|+-a + N(0, sigma)| <= U)
    const double scale = sigma * std::numbers::sqrt2;
    return 0.5 * (std::erf((U - a) / scale) + std::erf((U + a) / scale));
  };
  double low = 0, high = a + 4 * sigma;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (inside(middle) < 0.95 ? low : high) = middle;
  }
  return high;
}

const FrontEndChannel& FrontEndCalibration::channel(std::string_view name) const {
  std::string known;
  for (const FrontEndChannel& c : channels) {
    if (c.name == name) return c;
    known += (known.empty() ? "" : ", ") + c.name;
  }
  throw UserError(fmt::format("channel {}: expected one of {}", name, known));
}

FrontEndCalibration merge(const FrontEndCalibration& scale_factor, const FrontEndCalibration& bias) {
  if (scale_factor.unit != bias.unit)
    throw UserError(fmt::format("{} is of {}, {} of {}: expected calibrations of one unit", scale_factor.id,
                                scale_factor.unit, bias.id, bias.unit));
  FrontEndCalibration merged = scale_factor;
  merged.id = scale_factor.id + "+" + bias.id;
  merged.procedure = scale_factor.procedure + "+" + bias.procedure;
  merged.measured = std::max(scale_factor.measured, bias.measured);   // ISO 8601: the later one
  for (FrontEndChannel& c : merged.channels) {
    const FrontEndChannel& b = bias.channel(c.name);
    c.bias_A = b.bias_A;
    c.bias_loop = b.bias_loop;
    c.bias_budget = b.bias_budget;
  }
  merged.oscillator = bias.oscillator;
  merged.oscillator_budget = bias.oscillator_budget;
  for (const auto* list : {&bias.instruments, &bias.files}) {
    auto& target = list == &bias.files ? merged.files : merged.instruments;
    for (const std::string& item : *list)
      if (std::find(target.begin(), target.end(), item) == target.end()) target.push_back(item);
  }
  return merged;
}

std::string to_json(const FrontEndCalibration& c) {
  Json j;
  j["schema"] = kSchema;
  j["id"] = c.id;
  j["procedure"] = c.procedure;
  j["measured"] = c.measured;
  j["unit"] = c.unit;
  j["version"] = c.version;
  j["instruments"] = c.instruments;
  j["files"] = c.files;
  j["channels"] = Json::array();
  for (const FrontEndChannel& channel : c.channels) {
    Json k;
    k["name"] = channel.name;
    k["K_N0_C"] = channel.K_N0_C;
    k["K_P0_C"] = channel.K_P0_C;
    k["dsf_N"] = json_of(channel.dsf_N);
    k["dsf_P"] = json_of(channel.dsf_P);
    k["bias_A"] = json_of(channel.bias_A);
    k["bias_loop"] = Json::array();
    for (const HalfLoop& h : channel.bias_loop) k["bias_loop"].push_back({h.temperature_degC, h.half_A});
    k["dsf_N_budget"] = json_of(channel.dsf_N_budget);
    k["dsf_P_budget"] = json_of(channel.dsf_P_budget);
    k["bias_budget"] = json_of(channel.bias_budget);
    j["channels"].push_back(std::move(k));
  }
  j["oscillator"] = json_of(c.oscillator);
  j["oscillator_budget"] = json_of(c.oscillator_budget);
  return j.dump(1) + "\n";
}

FrontEndCalibration front_end_calibration_from_json(const std::string& text, const std::string& name) {
  const Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) throw UserError(name + ": expected a front-end calibration as JSON");
  const Reader root(document, name);
  if (root.at("schema").text() != kSchema) root.refuse("schema", fmt::format("expected \"{}\"", kSchema));
  FrontEndCalibration c;
  c.id = root.at("id").text();
  c.procedure = root.at("procedure").text();
  c.measured = root.at("measured").text();
  c.unit = root.at("unit").text();
  c.version = root.at("version").text();
  c.instruments = root.at("instruments").texts();
  c.files = root.at("files").texts();
  for (const Reader& r : root.at("channels").items()) {
    FrontEndChannel channel;
    channel.name = r.at("name").text();
    channel.K_N0_C = r.at("K_N0_C").number();
    channel.K_P0_C = r.at("K_P0_C").number();
    channel.dsf_N = law_of(r.at("dsf_N"));
    channel.dsf_P = law_of(r.at("dsf_P"));
    channel.bias_A = law_of(r.at("bias_A"));
    for (const Reader& point : r.at("bias_loop").items()) {
      const std::vector<Reader> pair = point.items();
      if (pair.size() != 2) point.refuse("", "expected [temperature_degC, half_A]");
      channel.bias_loop.push_back({pair[0].number(), pair[1].number()});
    }
    if (!std::ranges::is_sorted(channel.bias_loop, {}, &HalfLoop::temperature_degC))
      r.refuse("bias_loop", "expected ascending temperatures");
    channel.dsf_N_budget = budget_of(r.at("dsf_N_budget"));
    channel.dsf_P_budget = budget_of(r.at("dsf_P_budget"));
    channel.bias_budget = budget_of(r.at("bias_budget"));
    c.channels.push_back(std::move(channel));
  }
  c.oscillator = law_of(root.at("oscillator"));
  c.oscillator_budget = budget_of(root.at("oscillator_budget"));
  return c;
}

void save(const FrontEndCalibration& calibration, const std::filesystem::path& path) {
  const std::filesystem::path part = path.string() + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out << to_json(calibration) << std::flush;
    if (!out) throw UserError(path.string() + ": cannot be written");
  }
  std::filesystem::rename(part, path);
}

FrontEndCalibration load_front_end_calibration(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError(path.string() + ": cannot be read: expected a front-end calibration as JSON");
  std::ostringstream text;
  text << in.rdbuf();
  return front_end_calibration_from_json(text.str(), path.string());
}

}  // namespace waverig::estimator
