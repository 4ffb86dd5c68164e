// How much two pictures of one size differ: for tests of ours and of others.
//
// psnr_db over all channels, infinity where equal. ssim: mean structural similarity of the luma over Gaussian
// windows of 11 x 11 pixels (Wang, Bovik, Sheikh, Simoncelli, Image Quality Assessment, IEEE TIP 2004);
// pictures smaller than a window count as one. Throws Error where the sizes differ.
#pragma once

#include "core/image.h"

namespace splatcut {

struct PictureDifference {
  int largest = 0;          // of any channel of any pixel, levels of 255
  double share_beyond = 0;  // of pixels with a channel that differs by more than `levels`, [0, 1]
  double psnr_db = 0;
  double ssim = 0;
};

// levels: differences up to this do not count in share_beyond.
PictureDifference picture_difference(const Image<Rgb8>& a, const Image<Rgb8>& b, int levels = 0);
// Of pictures with alpha, or of 16 bits: alpha is a channel, and ssim the smaller one of those on black and
// on white. The colours are multiplied by alpha; `largest` is rounded up.
PictureDifference picture_difference(const Image<Rgba16>& a, const Image<Rgba16>& b, int levels = 0);

// Where they differ: eight times the difference of each channel, or of alpha where that is larger.
Image<Rgb8> difference_picture(const Image<Rgb8>& a, const Image<Rgb8>& b);
Image<Rgb8> difference_picture(const Image<Rgba16>& a, const Image<Rgba16>& b);

Image<Rgba16> rgba16_of(const Image<Rgb8>& picture);  // opaque

}  // namespace splatcut
