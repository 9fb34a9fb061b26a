#include "estimator/evaluation/sample_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "lcmtypes/flags.h"

namespace waverig::evaluation {
namespace {

constexpr const char* kHeader = "utime,ax,ay,az,gx,gy,gz[,mx,my,mz][,temperature]";

}  // namespace

SampleCsvReader::SampleCsvReader(const std::filesystem::path& path) : csv_(path) {
  std::vector<std::string> expected = {"utime", "ax", "ay", "az", "gx", "gy", "gz"};
  if (csv_.find("mx") >= 0) {
    mag_ = static_cast<int>(expected.size());
    expected.insert(expected.end(), {"mx", "my", "mz"});
  }
  if (csv_.find("temperature") >= 0) {
    temperature_ = static_cast<int>(expected.size());
    expected.emplace_back("temperature");
  }
  if (csv_.columns() != expected) throw csv_.header_complaint(kHeader);
}

bool SampleCsvReader::next(estimator::ImuSample& sample) {
  if (!csv_.next()) {
    if (rows_ == 0)
      throw UserError(fmt::format("{}: no samples after the header; expected at least one row", csv_.name()));
    return false;
  }
  sample.utime = csv_.integer(0);
  if (rows_ > 0 && sample.utime <= last_utime_)
    throw csv_.complaint(0, fmt::format("a time after {} (microseconds that grow)", last_utime_));
  last_utime_ = sample.utime;
  sample.seq = rows_++;
  for (int axis = 0; axis < 3; ++axis) {
    sample.f_B[axis] = csv_.number(1 + axis);
    sample.w_NB_B[axis] = csv_.number(4 + axis);
    sample.m_B_uT[axis] = mag_ < 0 ? 0.0 : csv_.number_or_nan(mag_ + axis);
  }
  const bool magnetic = mag_ >= 0 && sample.m_B_uT.allFinite();
  if (!magnetic) sample.m_B_uT.setZero();
  sample.flags = magnetic ? 0 : flag::kNoMagnetometer;
  sample.temperature_degC = temperature_ < 0 ? estimator::kUnknown : csv_.number_or_nan(temperature_);
  return true;
}

SampleCsvWriter::SampleCsvWriter(const std::filesystem::path& path, bool magnetometer, bool temperature)
    : file_(path), magnetometer_(magnetometer), temperature_(temperature) {
  file_.write("utime,ax,ay,az,gx,gy,gz");
  if (magnetometer_) file_.write(",mx,my,mz");
  if (temperature_) file_.write(",temperature");
  file_.write("\n");
}

void SampleCsvWriter::write(const estimator::ImuSample& s) {
  fmt::memory_buffer row;
  const auto out = std::back_inserter(row);
  fmt::format_to(out, "{},{},{},{},{},{},{}", s.utime, s.f_B.x(), s.f_B.y(), s.f_B.z(), s.w_NB_B.x(),
                 s.w_NB_B.y(), s.w_NB_B.z());
  if (magnetometer_) {
    if ((s.flags & flag::kNoMagnetometer) != 0)
      fmt::format_to(out, ",,,");
    else
      fmt::format_to(out, ",{},{},{}", s.m_B_uT.x(), s.m_B_uT.y(), s.m_B_uT.z());
  }
  if (temperature_) {
    if (std::isnan(s.temperature_degC))
      fmt::format_to(out, ",");
    else
      fmt::format_to(out, ",{}", s.temperature_degC);
  }
  row.push_back('\n');
  file_.write({row.data(), row.size()});
}

void SampleCsvWriter::close() { file_.commit(); }

}  // namespace waverig::evaluation
