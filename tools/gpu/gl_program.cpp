#include "tools/gpu/gl_program.h"

#include "tools/gpu/shader_text.h"

namespace gim {
namespace {

constexpr std::string_view kShared = "gim.glsl";

GLenum stage_of(std::string_view name) {
    const std::string_view end = name.substr(name.rfind('.') + 1);
    if (end == "vert") return GL_VERTEX_SHADER;
    if (end == "tesc") return GL_TESS_CONTROL_SHADER;
    if (end == "tese") return GL_TESS_EVALUATION_SHADER;
    if (end == "frag") return GL_FRAGMENT_SHADER;
    return GL_COMPUTE_SHADER;
}

std::string source_of(std::string_view name) {
    std::string text(shader_text(name));
    const std::string line = "#include \"" + std::string(kShared) + "\"\n";
    const size_t at = text.find(line);
    if (at != std::string::npos) text.replace(at, line.size(), shader_text(kShared));
    return text;
}

std::string log_of(GLuint object, decltype(glGetShaderiv) get, decltype(glGetShaderInfoLog) read) {
    GLint length = 0;
    get(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<size_t>(length) + 1, '\0');
    read(object, length + 1, &length, log.data());
    log.resize(static_cast<size_t>(length));
    return log;
}

Result<void> attach(GLuint program, std::string_view name) {
    const std::string source = source_of(name);
    if (source.empty()) return Error{Stage::kInput, "there is no shader " + std::string(name)};
    const char* text = source.c_str();
    const GLuint shader = glCreateShader(stage_of(name));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint is_compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
    const std::string log = is_compiled ? "" : log_of(shader, glGetShaderiv, glGetShaderInfoLog);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // it stays while the program has it
    if (!is_compiled) return Error{Stage::kInput, std::string(name) + " does not compile: " + log};
    return {};
}

}  // namespace

Result<GlProgram> GlProgram::build(const std::vector<std::string_view>& names,
                                   const std::vector<const char*>& captured) {
    GlProgram program(glCreateProgram());
    const GLuint name = program.object_.name();
    std::string all;
    for (const std::string_view part : names) {
        if (const Result<void> attached = attach(name, part); !attached.ok()) return attached.error();
        all += (all.empty() ? "" : ", ") + std::string(part);
    }
    if (!captured.empty())
        glTransformFeedbackVaryings(name, static_cast<GLsizei>(captured.size()), captured.data(),
                                    GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(name);
    GLint is_linked = 0;
    glGetProgramiv(name, GL_LINK_STATUS, &is_linked);
    if (!is_linked)
        return Error{Stage::kInput, all + " do not link: " + log_of(name, glGetProgramiv, glGetProgramInfoLog)};
    return program;
}

}  // namespace gim
