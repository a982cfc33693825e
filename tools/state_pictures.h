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

    Result<bool> make_folder() const;
    // Draws each state to NN-name.png. After the first failure, leaves out later states.
    Observer observer();
    // Writes strip.png: all states from left to right, or eight spread over them if there are more. Returns the first
    // failure of all.
    Result<bool> finish();

  private:
    void add(const Snapshot& state);
    Result<bool> save(const std::string& name, const Picture& picture) const;

    std::string folder_;
    std::vector<Panel> panels_;
    Result<bool> state_ = true;
};

}  // namespace gim
