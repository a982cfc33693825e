// Heights of a picture that lies on a plane, filtered for a spacing of samples.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/emboss.h"

namespace gim {

class PictureHeights {
  public:
    // size: of the longer side in the plane. The middle of the picture is at (0, 0), its upper side towards +y.
    PictureHeights(const HeightPicture& picture, double size);

    // Chooses the picture that is as fine as samples so far apart can show. spacing > 0.
    void filter_for(double spacing);

    // Linear between pixels; 0 outside of the picture.
    double at(const Vec2& place) const;

    double width() const { return width_; }
    double height() const { return height_; }
    double pixel() const { return width_ / pictures_[0].width; }  // in the plane, unfiltered

  private:
    std::vector<HeightPicture> pictures_;  // each of half the resolution of the one before
    size_t chosen_ = 0;
    double width_, height_;
};

}  // namespace gim
