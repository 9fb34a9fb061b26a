// VideoWriter: pictures into an MP4 file of H.264, through libav.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "render/image.h"

namespace waverig::render {

struct VideoSettings {
  int width_px = 1280, height_px = 720;  // both even
  int frames_per_s = 30;
  int quality = 21;                // x264's constant rate factor: smaller is finer and larger
  std::string title{}, comment{};  // into the file's metadata
};

class VideoWriter {
 public:
  // Throws UserError where the file cannot be made, the size is odd, or libav
  // has no H.264 encoder, std::runtime_error (finish() too) where the disk is full.
  VideoWriter(const std::filesystem::path& path, const VideoSettings& settings);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void add(const Image& frame);  // of the settings' size
  void finish();                 // a file that was not finished is removed

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace waverig::render
