// Draws the states of an encoding as PNGs (gim encode --debug-dir): the surface with its cut, and the map below it.
#pragma once

#include <string>
#include <vector>

#include "gim/encoder.h"
#include "tools/render.h"

namespace gim {

class StatePictures {
  public:
    // make_folder() makes `folder` if it is missing. Files of the same names are overwritten.
    explicit StatePictures(std::string folder) : folder_(std::move(folder)) {}

    // True if the name is that of the folder, or could be that of a picture.
    bool may_replace(const std::string& name) const;

    Result<void> make_folder() const;
    // Draws each state to NN-name.png. The first failure is kept, later states are then left out.
    Observer observer();
    // strip.png: all states (eight of them, spread, where there are more) from left to right. The first failure of all.
    Result<void> finish();

  private:
    void add(const Snapshot& state);
    Result<void> save(const std::string& name, const Picture& picture) const;

    std::string folder_;
    std::vector<Panel> panels_;
    Result<void> state_;
};

}  // namespace gim
