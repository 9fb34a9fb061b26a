#include "render/scene/video_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <string>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig::render {
namespace {

std::string reason(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error, text.data(), text.size());
  return text.data();
}

}  // namespace

struct VideoWriter::Stream {
  std::filesystem::path path;
  AVFormatContext* format = nullptr;
  AVCodecContext* codec = nullptr;
  AVStream* stream = nullptr;
  AVFrame* frame = nullptr;
  AVPacket* packet = nullptr;
  SwsContext* convert = nullptr;
  std::int64_t frames = 0;
  bool finished = false;

  void check(int result, const char* what) const {
    if (result < 0)
      refuse_place({AVUNERROR(result), std::generic_category()},
                   path.string() + ": " + what + ": " + reason(result));
  }
  ~Stream() {
    sws_freeContext(convert);
    av_packet_free(&packet);
    av_frame_free(&frame);
    avcodec_free_context(&codec);
    if (format != nullptr) {
      if (format->pb != nullptr) avio_closep(&format->pb);
      avformat_free_context(format);
    }
    std::error_code ignored;
    if (!finished) std::filesystem::remove(path, ignored);
  }
  // A null frame drains the encoder.
  void encode(const AVFrame* picture) {
    check(avcodec_send_frame(codec, picture), "the encoder takes no frame");
    for (;;) {
      const int result = avcodec_receive_packet(codec, packet);
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
      check(result, "the encoder fails");
      av_packet_rescale_ts(packet, codec->time_base, stream->time_base);
      packet->stream_index = stream->index;
      check(av_interleaved_write_frame(format, packet), "cannot be written");
    }
  }
};

VideoWriter::VideoWriter(const std::filesystem::path& path, const VideoSettings& settings)
    : stream_(std::make_unique<Stream>()) {
  av_log_set_level(AV_LOG_ERROR);  // x264 tells its options on stderr otherwise
  Stream& s = *stream_;
  s.path = path;
  if (settings.width_px < 16 || settings.height_px < 16 || settings.width_px % 2 != 0 ||
      settings.height_px % 2 != 0)
    throw UserError(path.string() + ": " + std::to_string(settings.width_px) + " x " +
                    std::to_string(settings.height_px) + " pixels: even numbers of at least 16 expected");
  if (settings.frames_per_s < 1 || settings.frames_per_s > 240)
    throw UserError(path.string() + ": " + std::to_string(settings.frames_per_s) +
                    " frames a second: 1 to 240 expected");
  s.check(avformat_alloc_output_context2(&s.format, nullptr, "mp4", path.c_str()), "no MP4 in this libav");
  const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
  if (encoder == nullptr) encoder = avcodec_find_encoder(AV_CODEC_ID_H264);
  if (encoder == nullptr)
    throw UserError(path.string() + ": this libav has no H.264 encoder (Debian's libavcodec has libx264)");
  s.codec = avcodec_alloc_context3(encoder);
  s.codec->width = settings.width_px;
  s.codec->height = settings.height_px;
  s.codec->time_base = {1, settings.frames_per_s};
  s.codec->framerate = {settings.frames_per_s, 1};
  s.codec->pix_fmt = AV_PIX_FMT_YUV420P;
  s.codec->colorspace = AVCOL_SPC_BT709;
  s.codec->color_primaries = AVCOL_PRI_BT709;
  s.codec->color_trc = AVCOL_TRC_BT709;
  s.codec->color_range = AVCOL_RANGE_MPEG;
  s.codec->gop_size = 2 * settings.frames_per_s;
  s.codec->thread_count = 1;  // the same bytes on every machine; drawing is the slower part
  av_opt_set(s.codec->priv_data, "preset", "veryfast", 0);
  av_opt_set(s.codec->priv_data, "crf", std::to_string(settings.quality).c_str(), 0);
  if ((s.format->oformat->flags & AVFMT_GLOBALHEADER) != 0) s.codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  s.check(avcodec_open2(s.codec, encoder, nullptr), "the H.264 encoder does not open");
  s.stream = avformat_new_stream(s.format, nullptr);
  s.stream->time_base = s.codec->time_base;
  s.stream->avg_frame_rate = s.codec->framerate;
  s.check(avcodec_parameters_from_context(s.stream->codecpar, s.codec), "the stream cannot be described");
  if (!settings.title.empty()) av_dict_set(&s.format->metadata, "title", settings.title.c_str(), 0);
  if (!settings.comment.empty()) av_dict_set(&s.format->metadata, "comment", settings.comment.c_str(), 0);
  s.check(avio_open(&s.format->pb, path.c_str(), AVIO_FLAG_WRITE), "cannot be made");
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "+faststart", 0);
  const int header = avformat_write_header(s.format, &options);
  av_dict_free(&options);
  s.check(header, "cannot be written");
  s.frame = av_frame_alloc();
  s.frame->format = s.codec->pix_fmt;
  s.frame->width = settings.width_px;
  s.frame->height = settings.height_px;
  s.check(av_frame_get_buffer(s.frame, 0), "no memory for a frame");
  s.packet = av_packet_alloc();
  s.convert = sws_getContext(settings.width_px, settings.height_px, AV_PIX_FMT_RGBA, settings.width_px,
                             settings.height_px, AV_PIX_FMT_YUV420P, SWS_BILINEAR, nullptr, nullptr, nullptr);
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(s.convert, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& image) {
  Stream& s = *stream_;
  if (image.width_px != s.codec->width || image.height_px != s.codec->height)
    throw std::invalid_argument("a frame of the film's size expected");
  s.check(av_frame_make_writable(s.frame), "no memory for a frame");
  const std::array<const std::uint8_t*, 1> from = {image.rgba.data()};
  const std::array<int, 1> stride = {4 * image.width_px};
  sws_scale(s.convert, from.data(), stride.data(), 0, image.height_px, s.frame->data, s.frame->linesize);
  s.frame->pts = s.frames++;
  s.encode(s.frame);
}

void VideoWriter::finish() {
  Stream& s = *stream_;
  s.encode(nullptr);
  s.check(av_write_trailer(s.format), "cannot be finished");
  s.check(avio_closep(&s.format->pb), "cannot be finished");
  s.finished = true;
}

}  // namespace waverig::render
