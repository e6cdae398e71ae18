// `make_still VIDEO NUMBER OUT.y4m`: one picture of a video, repeated, as a film that Chromium uses
// as a camera (--use-file-for-fake-video-capture).  Nothing moves in it, so cameras that play such
// films all see the same instant.
#include <cstdlib>
#include <fstream>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  cv::VideoCapture video(argv[1]);
  cv::Mat picture;
  for (int i = 0; i <= std::atoi(argv[2]); ++i) {
    if (!video.read(picture)) return 1;
  }
  cv::Mat planes;
  cv::cvtColor(picture, planes, cv::COLOR_BGR2YUV_I420);  // width and height have to be even
  std::ofstream out(argv[3], std::ios::binary);
  out << "YUV4MPEG2 W" << picture.cols << " H" << picture.rows << " F10:1 Ip A1:1 C420jpeg\n";
  constexpr int kPictures = 10;
  for (int i = 0; i < kPictures; ++i) {
    out << "FRAME\n";
    out.write(reinterpret_cast<const char*>(planes.data),
              static_cast<std::streamsize>(planes.total() * planes.elemSize()));
  }
  return out.good() ? 0 : 1;
}
