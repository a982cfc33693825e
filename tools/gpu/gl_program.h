// Programs from the shaders of decoder/shaders/.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gim/encoder.h"
#include "tools/gpu/gl_object.h"

namespace gim {

class GlProgram {
  public:
    // Names of files; what comes behind the dot tells the stage. Errors give the driver's log. captured: outputs that
    // transform feedback writes, one after the other.
    static Result<GlProgram> build(const std::vector<std::string_view>& names,
                                   const std::vector<const char*>& captured = {});

    void use() const { glUseProgram(object_.name()); }

  private:
    explicit GlProgram(GLuint name) : object_(name) {}
    GlObject<delete_program> object_;
};

}  // namespace gim
