#include "estimator/calibration/front_end.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

TemperatureLaw constant(double value) {
  TemperatureLaw law;
  law.coefficients = Eigen::VectorXd::Constant(1, value);
  law.covariance = Eigen::MatrixXd::Identity(1, 1);
  return law;
}

std::string file_text() {
  FrontEndCalibration c;
  c.id = "unit7";
  c.instruments = {"calibrator"};
  FrontEndChannel& channel = c.channels.emplace_back();
  channel.name = "accel_1";
  channel.K_N0_C = channel.K_P0_C = 1e-9;
  channel.dsf_N = channel.dsf_P = channel.bias_A = c.oscillator = constant(1e-6);
  channel.dsf_N_budget = {{"calibrator", 1e-6, 'B'}};
  channel.bias_loop = {{0, 1e-9}};
  return to_json(c);
}

TEST(FrontEndFile, IsReadAsItWasWritten) {
  EXPECT_EQ(to_json(front_end_calibration_from_json(file_text(), "f.json")), file_text());
}

TEST(FrontEndFile, NamesFileKeyValueAndWhatWasExpected) {
  struct Case {
    std::string from, to, complaint;
  };
  const std::vector<Case> cases = {
      {"\"id\"", "\"no\"", "f.json: id is missing: expected text"},
      {"\"K_N0_C\"", "\"no\"", "f.json: channels[0].K_N0_C is missing: expected a number"},
      {"\"K_N0_C\": 1e-09", "\"K_N0_C\": \"x\"", "f.json: channels[0].K_N0_C: \"x\": expected a number"},
      {"\"K_P0_C\": 1e-09", "\"K_P0_C\": -1", "f.json: channels[0].K_P0_C: -1: expected a number above 0"},
      {"\"bias_A\"", "\"no\"", "channels[0].bias_A is missing: expected a law of the temperature"},
      {"\"channels\"", "\"no\"", "f.json: channels is missing: expected a list"},
      {"\"type\": \"B\"", "\"type\": \"C\"",
       "channels[0].dsf_N_budget[0].type: \"C\": expected \"A\" or \"B\""},
      {"waverig-front-end-1", "other", "f.json: schema: \"other\": expected \"waverig-front-end-1\""},
      {"{\n", "{\n,", "f.json, line 2: not valid JSON: expected a front-end calibration"},
  };
  for (const Case& c : cases) {
    std::string text = file_text();
    ASSERT_NE(text.find(c.from), std::string::npos) << c.from << text;
    text.replace(text.find(c.from), c.from.size(), c.to);
    try {
      front_end_calibration_from_json(text, "f.json");
      ADD_FAILURE() << "taken: " << c.to;
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find(c.complaint), std::string::npos) << error.what();
    }
  }
}

// As --scale-factors where somebody names the run's directory.
TEST(FrontEndFile, IsNoFolder) {
  const std::string folder = std::filesystem::temp_directory_path();
  try {
    load_front_end_calibration(folder);
    ADD_FAILURE() << "taken";
  } catch (const UserError& error) {
    EXPECT_EQ(error.what(), folder + ": cannot be read: Is a directory; expected a front-end calibration as JSON");
  }
}

TEST(FrontEndFile, HasNoKeyTwice) {
  std::string text = file_text();
  text.insert(text.find("\"K_N0_C\""), "\"K_N0_C\": 2e-9, ");
  try {
    front_end_calibration_from_json(text, "f.json");
    ADD_FAILURE() << "taken";
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(), "f.json: 'K_N0_C' is there twice: expected it once");
  }
}

TEST(FrontEndFile, OfAnythingElseIsRefusedInOneLine) {
  for (const char* text : {"", "3", "[]", "{}", "null", "\xff\xfe", "{\"schema\": 1e999}"}) {
    try {
      front_end_calibration_from_json(text, "f.json");
      ADD_FAILURE() << "taken: " << text;
    } catch (const UserError& error) {
      const std::string sentence = error.what();
      EXPECT_TRUE(sentence.starts_with("f.json")) << sentence;
      EXPECT_NE(sentence.find("expected"), std::string::npos) << sentence;
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    }
  }
}

}  // namespace
}  // namespace waverig::estimator
