#include "estimator/evaluation/heave_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "estimator/evaluation/csv_reader.h"

namespace waverig::evaluation {

namespace {

constexpr std::int64_t kLatest_us =
    1'000'000'000'000'000'000;       // 30,000 years: differences stay whole numbers
constexpr double kHighest_m = 10e3;  // what stands for "no value" is beyond it

}  // namespace

HeaveSeries read_heave_csv(const std::filesystem::path& path) {
  CsvReader csv(path);
  if (csv.columns().size() < 2 || csv.columns()[0] != "utime" || csv.columns()[1] != "heave_m")
    throw csv.header_complaint("utime,heave_m[,heave_sigma_m]");
  csv.refuse_twice({"heave_m", "heave_sigma_m", "moving"});
  const int sigma = csv.find("heave_sigma_m"), moving = csv.find("moving");
  HeaveSeries series;
  while (csv.next()) {
    const std::int64_t utime = csv.integer(0);
    if (!series.utime.empty() && utime <= series.utime.back())
      throw csv.complaint(0, fmt::format("a time after {} (microseconds that grow)", series.utime.back()));
    if (utime < -kLatest_us || utime > kLatest_us)
      throw csv.complaint(0, fmt::format("microseconds within {:g} of 0", static_cast<double>(kLatest_us)));
    series.utime.push_back(utime);
    series.heave_m.push_back(csv.number_or_nan(1));
    if (std::abs(series.heave_m.back()) > kHighest_m)
      throw csv.complaint(1, fmt::format("metres within {:g} of 0, or an empty cell", kHighest_m));
    series.heave_sigma_m.push_back(sigma < 0 ? estimator::kUnknown : csv.number_or_nan(sigma));
    if (series.heave_sigma_m.back() < 0)
      throw csv.complaint(sigma, "a number of 0 or more, or an empty cell");
    if (moving >= 0) series.moving.push_back(csv.number(moving) != 0);
  }
  if (series.utime.empty())
    throw UserError(fmt::format("{}: no heave after the header; expected at least one row", csv.name()));
  return series;
}

HeaveCsvWriter::HeaveCsvWriter(const std::filesystem::path& path) : file_(path) {
  file_.write("utime,heave_m,heave_sigma_m\n");
}

void HeaveCsvWriter::write(const estimator::HeaveSample& s) {
  const auto cell = [](double value) {
    return std::isnan(value) ? std::string() : fmt::format("{:.6f}", value);
  };
  file_.write(fmt::format("{},{},{}\n", s.utime, cell(s.heave_m), cell(s.heave_sigma_m)));
}

void HeaveCsvWriter::flush() { file_.flush(); }

void HeaveCsvWriter::close() { file_.commit(); }

}  // namespace waverig::evaluation
