// OpenGL 4.5 without a window.
#pragma once

#include <memory>
#include <string>

#include "gim/encoder.h"

namespace gim {

// A context that is current on the thread that made it, until it goes. All other objects of this folder live on that
// thread, and go before it does.
class EglContext {
  public:
    // Tries a display without a surface (Mesa), then each device, then the default display.
    static Result<EglContext> create();
    EglContext(EglContext&&) noexcept;
    EglContext& operator=(EglContext&&) noexcept;
    ~EglContext();

    std::string renderer() const;  // the driver's name for itself, with its version

  private:
    struct State;
    explicit EglContext(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace gim
