#include "rig/acquisition/acquisition.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"
#include "rig/acquisition/serial_port.h"
#include "rig/frontend/simulated_unit.h"

namespace waverig::rig {
namespace {

constexpr std::size_t kFrame = 40;

std::vector<std::uint8_t> frames_at_rest(const UnitSettings& settings, int frames) {
  SimulatedUnit unit(settings, draw_unit(settings, 3), 4);
  std::vector<std::uint8_t> bytes;
  BodyMotion m;
  unit.step(m, 0, bytes);
  while (bytes.size() < kFrame * static_cast<std::size_t>(frames)) {
    m.utime += 2000;
    unit.step(m, 2e-3, bytes);
  }
  return bytes;
}

std::vector<estimator::ImuSample> samples_of(Acquisition& acquisition, std::span<const std::uint8_t> bytes) {
  std::vector<estimator::ImuSample> samples;
  acquisition.add(bytes, [&](const UnitCounts&, const estimator::ImuSample& s) { samples.push_back(s); });
  return samples;
}

TEST(Acquisition, AppliesTheCalibrationAndSaysWhenItHasNone) {
  const auto bytes = frames_at_rest(datasheet_unit(), 10);
  Acquisition raw(nominal_sensitivities(datasheet_unit())),
      calibrated(nominal_sensitivities(datasheet_unit()));
  estimator::AccelerometerCalibration c;
  c.M << 1.01, 0.02, 0, 0, 0.98, 0, 0.01, 0, 1;
  c.b_mps2 << 0.1, -0.2, 0.3;
  estimator::GyroscopeCalibration g;
  g.offset_radps << 0.01, 0.02, -0.03;
  calibrated.apply(c, g);
  const auto before = samples_of(raw, bytes), after = samples_of(calibrated, bytes);
  ASSERT_EQ(before.size(), 10U);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_LT((c.M * after[k].f_B + c.b_mps2 - before[k].f_B).norm(), 1e-12);
    EXPECT_LT((after[k].w_NB_B + g.offset_radps - before[k].w_NB_B).norm(), 1e-15);
    EXPECT_NE(before[k].flags & flag::kUncalibrated, 0);
    EXPECT_EQ(after[k].flags & flag::kUncalibrated, 0);
    EXPECT_NEAR(after[k].temperature_degC, 24, 0.01);
  }
}

TEST(Acquisition, FlagsTheSampleAfterAGap) {
  auto bytes = frames_at_rest(ideal_unit(), 20);
  bytes.erase(bytes.begin() + 5 * kFrame, bytes.begin() + 8 * kFrame);
  Acquisition acquisition(nominal_sensitivities(ideal_unit()));
  const auto samples = samples_of(acquisition, bytes);
  ASSERT_EQ(samples.size(), 17U);
  for (std::size_t k = 0; k < samples.size(); ++k)
    EXPECT_EQ((samples[k].flags & flag::kGap) != 0, k == 5) << k;
  EXPECT_EQ(samples[5].seq, 8);
  EXPECT_EQ(acquisition.statistics().lost, 3);
}

TEST(Acquisition, CountsTheSamplesOfARecordFromZero) {
  const auto bytes = frames_at_rest(ideal_unit(), 20);
  Acquisition acquisition(nominal_sensitivities(ideal_unit()));
  samples_of(acquisition, std::span(bytes).first(7 * kFrame));
  acquisition.begin_record();
  const auto samples =
      samples_of(acquisition, std::span(bytes).subspan(9 * kFrame));  // two lost before the record
  EXPECT_EQ(samples.front().seq, 0);
  EXPECT_EQ(samples.front().flags & flag::kGap, 0);
  EXPECT_EQ(samples.back().seq, 10);
}

TEST(Acquisition, UsesTheSensitivitiesItIsGiven) {
  Sensitivities s = nominal_sensitivities(ideal_unit());
  s.negative_quantum_C *= 1.1;
  s.positive_quantum_C *= 0.9;
  s.converter_bias_A.setConstant(1e-5);
  Acquisition nominal(nominal_sensitivities(ideal_unit())), calibrated(s);
  SimulatedUnit unit(ideal_unit(), draw_unit(ideal_unit(), 1), 1);
  std::vector<std::uint8_t> bytes;
  BodyMotion m;
  m.acceleration_N = {5, 0, 0};
  unit.step(m, 0, bytes);
  for (int k = 0; k < 50; ++k) unit.step(m, 2e-3, bytes);
  const auto a = samples_of(nominal, bytes), b = samples_of(calibrated, bytes);
  const double bias = 1e-5 / s.current_per_accel_ApMps2;
  EXPECT_NEAR(b[3].f_B.x(), 1.1 * a[3].f_B.x() + bias, 1e-12);
  EXPECT_NEAR(b[3].f_B.z(), 0.9 * a[3].f_B.z() + bias, 1e-12);
}

// The converter's own constants, as a calibration without error would find them.
estimator::FrontEndCalibration true_front_end(const UnitSettings& settings, const UnitParameters& unit) {
  estimator::FrontEndCalibration c;
  for (std::size_t i = 0; i < 3; ++i) {
    estimator::FrontEndChannel channel;
    channel.name = std::string("accel ") + "xyz"[i];
    channel.K_N0_C = unit.converter[i].negative_quantum_C / (1 + unit.converter[i].reset_clock_error);
    channel.K_P0_C = unit.converter[i].positive_quantum_C / (1 + unit.converter[i].reset_clock_error);
    channel.dsf_N.coefficients[0] = unit.converter[i].negative_scale_error;
    channel.dsf_P.coefficients[0] = unit.converter[i].positive_scale_error;
    channel.bias_A.coefficients[0] = unit.converter[i].bias_A;
    c.channels.push_back(channel);
  }
  c.oscillator.coefficients[0] = settings.front_end.master_clock_error;
  return c;
}

TEST(Acquisition, AFrontEndCalibrationTakesItsErrorsAway) {
  UnitSettings s = ideal_unit();
  s.front_end.scale_sigma = 5e-3;
  s.front_end.bias_sigma_A = 2e-5;
  s.front_end.reset_clock_error = 1e-3;
  s.front_end.master_clock_error = -2e-3;
  const UnitParameters parameters = draw_unit(s, 3);
  Acquisition nominal(nominal_sensitivities(s)), calibrated(nominal_sensitivities(s));
  calibrated.apply(true_front_end(s, parameters), {"accel x", "accel y", "accel z"});
  SimulatedUnit unit(s, parameters, 1);
  std::vector<std::uint8_t> bytes;
  BodyMotion m;
  m.acceleration_N = {5, -3, 0};
  unit.step(m, 0, bytes);
  for (int k = 0; k < 5000; ++k) unit.step(m, 2e-3, bytes);
  const auto mean_error = [&](Acquisition& acquisition) {
    Vector3d sum = Vector3d::Zero();
    const auto samples = samples_of(acquisition, bytes);
    for (const auto& sample : samples) sum += sample.f_B;
    return (sum / static_cast<double>(samples.size()) - Vector3d(5, -3, -kStandardGravity)).norm();
  };
  EXPECT_GT(mean_error(nominal), 0.01);
  EXPECT_LT(mean_error(calibrated), 5e-5);  // one quantum in ten seconds
  EXPECT_THROW(calibrated.apply(true_front_end(s, parameters), {"accel x", "accel y", "w"}), UserError);
}

TEST(Acquisition, AFrontEndCalibrationFollowsTheTemperature) {
  UnitSettings s = ideal_unit();
  s.temperature = {.mean_degC = 40};
  const UnitParameters parameters = draw_unit(s, 3);
  estimator::FrontEndCalibration front_end = true_front_end(s, parameters);
  front_end.channels[2].dsf_P.coefficients = Eigen::Vector2d(0, 1e-3);  // per degC, from 20 degC
  Acquisition acquisition(nominal_sensitivities(s)), nominal(nominal_sensitivities(s));
  acquisition.apply(front_end, {"accel x", "accel y", "accel z"});
  const auto bytes = frames_at_rest(s, 20);
  const auto warm = samples_of(acquisition, bytes), plain = samples_of(nominal, bytes);
  EXPECT_NEAR(warm[7].f_B.z() / plain[7].f_B.z(), 1.02, 1e-12);
}

TEST(Acquisition, RefusesALayoutWithoutItsFields) {
  FrameLayout layout = default_frame_layout();
  layout.fields.pop_back();
  EXPECT_THROW(Acquisition(nominal_sensitivities(ideal_unit()), layout), UserError);
}

// A pseudo-terminal: the unit's end and the path of the acquisition's end.
struct PseudoTerminal {
  PseudoTerminal() : descriptor(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (descriptor >= 0 && ::grantpt(descriptor) == 0 && ::unlockpt(descriptor) == 0)
      path = ::ptsname(descriptor);
  }
  ~PseudoTerminal() { close(); }
  void close() {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
  }
  int descriptor;
  std::string path;
};

TEST(SerialPort, CarriesFramesUnchanged) {
  PseudoTerminal terminal;
  if (terminal.path.empty()) GTEST_SKIP() << "no pseudo-terminals here";
  SerialPort port(terminal.path, 921600);
  const auto bytes = frames_at_rest(ideal_unit(), 500);
  Acquisition serial(nominal_sensitivities(ideal_unit())), memory(nominal_sensitivities(ideal_unit()));
  std::vector<estimator::ImuSample> from_serial;
  std::vector<std::uint8_t> buffer(4096);
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t put =
        ::write(terminal.descriptor, bytes.data() + at, std::min<std::size_t>(1000, bytes.size() - at));
    ASSERT_GT(put, 0);
    at += static_cast<std::size_t>(put);
    std::size_t got = 0;
    while (got < static_cast<std::size_t>(put)) {
      const auto piece = port.read(buffer, 5000);
      ASSERT_FALSE(piece.empty());
      got += piece.size();
      for (const auto& s : samples_of(serial, piece)) from_serial.push_back(s);
    }
  }
  const auto from_memory = samples_of(memory, bytes);
  ASSERT_EQ(from_serial.size(), from_memory.size());
  for (std::size_t k = 0; k < from_memory.size(); ++k) EXPECT_EQ(from_serial[k].f_B, from_memory[k].f_B);
}

TEST(SerialPort, TellsATimeOutFromALineThatIsGone) {
  PseudoTerminal terminal;
  if (terminal.path.empty()) GTEST_SKIP() << "no pseudo-terminals here";
  SerialPort port(terminal.path, 115200);
  std::vector<std::uint8_t> buffer(16);
  EXPECT_TRUE(port.read(buffer, 1).empty());
  port.write(std::vector<std::uint8_t>{'*', '\n', '\r', 0}, 1000);
  EXPECT_EQ(::read(terminal.descriptor, buffer.data(), buffer.size()), 4);
  EXPECT_EQ(buffer[1], '\n');
  terminal.close();
  EXPECT_THROW(port.read(buffer, 1000), std::runtime_error);
}

TEST(SerialPort, RefusesWhatIsNoPort) {
  EXPECT_THROW(SerialPort("/nonexistent/tty", 115200), UserError);
  EXPECT_THROW(SerialPort("/dev/null", 115200), UserError);
  EXPECT_THROW(SerialPort("/dev/null", 12345), UserError);
}

}  // namespace
}  // namespace waverig::rig
