// The results directory of a campaign. Work goes on in DIR.partial, which becomes DIR in one rename when
// everything is there: a partial result is never mistaken for a finished one, and a finished one is replaced
// only by a finished one.
#pragma once
#include <filesystem>
#include <string>

namespace waverig::rig {

class ResultsDirectory {
 public:
  enum class Mode { kFresh, kResume, kReplace };

  // kFresh refuses where DIR exists or a DIR.partial waits to be resumed; kResume goes on in DIR.partial (or
  // begins it); kReplace begins anew and lets an existing DIR stand until finish(), but takes the place of
  // results alone: a file, or a folder of anything else, is nobody's to remove. Throws UserError naming
  // --out.
  ResultsDirectory(const std::filesystem::path& directory, Mode mode);

  const std::filesystem::path& working() const { return working_; }
  std::filesystem::path runs() const { return working_ / "runs"; }
  std::filesystem::path figures() const { return working_ / "figures"; }

  // The settings that the directory belongs to, as resolved text, under a line with the version that makes
  // it: written when fresh, compared when resumed. Throws UserError where a resumed directory holds other
  // settings, or runs of another version.
  void claim(const std::string& resolved_settings, const std::string& version);
  void finish();

 private:
  std::filesystem::path directory_, working_;
  Mode mode_;
};

// A campaign judged into another directory: settings, calibrations and logs come with it, so that figures,
// report and compare take that directory as they take the first.
void refuse_other_campaign(const std::filesystem::path& from, const std::filesystem::path& to);  // UserError
void take_campaign(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace waverig::rig
