// The shipped procedures made short, in a directory of their own.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace waverig::rig::bench {

class ShortSequence {
 public:
  using Changes = std::vector<std::pair<std::string, std::string>>;

  explicit ShortSequence(const std::string& name, const Changes& more = {}) {
    static int number = 0;
    directory_ = std::filesystem::temp_directory_path() / ("waverig-bench-" + std::to_string(::getpid()) + "-" + std::to_string(number++));
    std::filesystem::create_directories(directory_);
    const std::filesystem::path shipped = std::filesystem::path(WAVERIG_SOURCE_DIR) / "rig" / "sequences";
    for (const auto& entry : std::filesystem::directory_iterator(shipped))
      std::filesystem::copy_file(entry.path(), directory_ / entry.path().filename());
    Changes changes = name == "scale_factor.toml" ? scale_factor() : Changes{};
    changes.insert(changes.end(), more.begin(), more.end());
    change(name, changes);
    file_ = directory_ / name;
  }
  ~ShortSequence() { std::filesystem::remove_all(directory_); }
  ShortSequence(const ShortSequence&) = delete;
  ShortSequence& operator=(const ShortSequence&) = delete;

  void change(const std::string& name, const Changes& changes) {
    std::ifstream in(directory_ / name);
    std::ostringstream stream;
    stream << in.rdbuf();
    std::string text = stream.str();
    for (const auto& [from, to] : changes) {
      const std::size_t at = text.find(from);
      if (at == std::string::npos) throw std::runtime_error(name + " no longer has: " + from);
      text.replace(at, from.size(), to);
    }
    std::ofstream(directory_ / name) << text;
  }

  const std::filesystem::path& file() const { return file_; }
  std::filesystem::path out(const std::string& name = "out") const { return directory_ / name; }

 private:
  static Changes scale_factor() {
    return {{"duration = \"38 h\" ", "# "},
            {"[\"-10 degC\", \"5 degC\", \"20 degC\", \"35 degC\", \"50 degC\"]", "[\"5 degC\", \"25 degC\", \"45 degC\"]"},
            {"gyros = [\"gyro_1\", \"gyro_2\", \"gyro_3\", \"gyro_4\", \"gyro_5\", \"gyro_6\"]", "gyros = [\"gyro_2\"]"},
            {"accels = [\"accel_1\", \"accel_2\", \"accel_3\", \"accel_4\"]", "accels = [\"accel_1\"]"},
            {"duration = \"100 s\"", "duration = \"5 s\""}};
  }

  std::filesystem::path directory_, file_;
};

}  // namespace waverig::rig::bench
