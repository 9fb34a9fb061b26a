#include "estimator/calibration/front_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "estimator/calibration/readable_json.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/disk.h"
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

constexpr const char *kList = "a list", *kNumber = "a number", *kText = "text";
constexpr std::size_t kShown = 40;  // of a value that is refused: enough to find it

// Reads one file with complaints that name the file, the key, the value and what was expected.
class Reader {
 public:
  Reader(const Json& node, std::string name, std::string key = "")
      : node_(node), name_(std::move(name)), key_(std::move(key)) {}

  Reader at(const std::string& key, const char* expected) const {
    const std::string path = key_.empty() ? key : key_ + "." + key;
    if (!node_.is_object() || !node_.contains(key))
      throw UserError(fmt::format("{}: {} is missing: expected {}", name_, path, expected));
    return {node_.at(key), name_, path};
  }
  std::vector<Reader> items(const std::string& key) const { return at(key, kList).items(); }
  double number(const std::string& key) const { return at(key, kNumber).number(); }
  double positive(const std::string& key) const {
    const double value = number(key);
    if (!(value > 0)) at(key, kNumber).refuse("a number above 0");
    return value;
  }
  std::string text(const std::string& key) const { return at(key, kText).text(); }
  std::vector<std::string> texts(const std::string& key) const {
    std::vector<std::string> list;
    for (const Reader& item : items(key)) list.push_back(item.text());
    return list;
  }
  std::vector<Reader> items() const {
    if (!node_.is_array()) refuse(kList);
    std::vector<Reader> list;
    for (std::size_t i = 0; i < node_.size(); ++i)
      list.emplace_back(node_[i], name_, fmt::format("{}[{}]", key_, i));
    return list;
  }
  double number() const {
    if (!node_.is_number()) refuse(kNumber);
    return node_.get<double>();
  }
  std::string text() const {
    if (!node_.is_string()) refuse(kText);
    return node_.get<std::string>();
  }
  [[noreturn]] void refuse(const std::string& expected) const {
    std::string value = node_.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (value.size() > kShown) value = value.substr(0, kShown) + "...";
    throw UserError(fmt::format("{}: {}: {}: expected {}", name_, key_, value, expected));
  }

 private:
  const Json& node_;
  std::string name_, key_;
};

TemperatureLaw law_of(const Reader& parent, const char* key) {
  const Reader r = parent.at(
      key, "a law of the temperature: coefficients, covariance, reference_degC, from_degC, to_degC");
  TemperatureLaw law;
  law.reference_degC = r.number("reference_degC");
  law.from_degC = r.number("from_degC");
  law.to_degC = r.number("to_degC");
  const std::vector<Reader> coefficients = r.items("coefficients"), rows = r.items("covariance");
  const auto n = static_cast<Eigen::Index>(coefficients.size());
  if (n == 0 || rows.size() != coefficients.size())
    r.at("covariance", kList).refuse(fmt::format("{} rows, one a coefficient, and at least one", n));
  law.coefficients.resize(n);
  law.covariance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    law.coefficients[i] = coefficients[static_cast<std::size_t>(i)].number();
    const std::vector<Reader> row = rows[static_cast<std::size_t>(i)].items();
    if (row.size() != coefficients.size())
      rows[static_cast<std::size_t>(i)].refuse(fmt::format("{} columns", n));
    for (Eigen::Index k = 0; k < n; ++k) law.covariance(i, k) = row[static_cast<std::size_t>(k)].number();
  }
  return law;
}

std::vector<BudgetTerm> budget_of(const Reader& parent, const char* key) {
  std::vector<BudgetTerm> budget;
  for (const Reader& item : parent.items(key)) {
    const std::string type = item.text("type");
    if (type != "A" && type != "B") item.at("type", kText).refuse("\"A\" or \"B\"");
    budget.push_back({item.text("name"), item.number("sigma"), type[0]});
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
  const double part =
      (temperature_degC - low.temperature_degC) / (high.temperature_degC - low.temperature_degC);
  return std::lerp(low.half_A, high.half_A, part);
}

double FrontEndChannel::bias_expanded_A(double temperature_degC) const {
  const double a = std::abs(half_loop_A(temperature_degC));
  const double sigma = std::max(bias_A.sigma_at(temperature_degC), 1e-15);
  const auto inside = [&](double U) {  // P(|+-a + N(0, sigma)| <= U)
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
  merged.measured = std::max(scale_factor.measured, bias.measured);  // ISO 8601: the later one
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
  Json document;
  try {
    document = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw UserError(fmt::format("{}, line {}: not valid JSON: expected a front-end calibration", name,
                                std::count(text.begin(), end, '\n') + 1));
  } catch (const Json::exception&) {
    throw UserError(fmt::format("{}: a number that is too large: expected a front-end calibration", name));
  }
  if (const std::string twice = key_given_twice(text); !twice.empty())
    throw UserError(fmt::format("{}: '{}' is there twice: expected it once", name, twice));
  const Reader root(document, name);
  if (root.text("schema") != kSchema) root.at("schema", kText).refuse(fmt::format("\"{}\"", kSchema));
  FrontEndCalibration c;
  c.id = root.text("id");
  c.procedure = root.text("procedure");
  c.measured = root.text("measured");
  c.unit = root.text("unit");
  c.version = root.text("version");
  c.instruments = root.texts("instruments");
  c.files = root.texts("files");
  for (const Reader& r : root.items("channels")) {
    FrontEndChannel channel;
    channel.name = r.text("name");
    channel.K_N0_C = r.positive("K_N0_C");
    channel.K_P0_C = r.positive("K_P0_C");
    channel.dsf_N = law_of(r, "dsf_N");
    channel.dsf_P = law_of(r, "dsf_P");
    channel.bias_A = law_of(r, "bias_A");
    for (const Reader& point : r.items("bias_loop")) {
      const std::vector<Reader> pair = point.items();
      if (pair.size() != 2) point.refuse("[temperature_degC, half_A]");
      channel.bias_loop.push_back({pair[0].number(), pair[1].number()});
    }
    if (!std::ranges::is_sorted(channel.bias_loop, {}, &HalfLoop::temperature_degC))
      r.at("bias_loop", kList).refuse("ascending temperatures");
    channel.dsf_N_budget = budget_of(r, "dsf_N_budget");
    channel.dsf_P_budget = budget_of(r, "dsf_P_budget");
    channel.bias_budget = budget_of(r, "bias_budget");
    c.channels.push_back(std::move(channel));
  }
  c.oscillator = law_of(root, "oscillator");
  c.oscillator_budget = budget_of(root, "oscillator_budget");
  return c;
}

void save(const FrontEndCalibration& calibration, const std::filesystem::path& path) {
  write_atomically(path, to_json(calibration));
}

FrontEndCalibration load_front_end_calibration(const std::filesystem::path& path) {
  return front_end_calibration_from_json(content_of(path, "a front-end calibration as JSON"), path.string());
}

}  // namespace waverig::estimator
