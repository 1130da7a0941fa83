#pragma once

#include <string>

struct GLFWwindow;

namespace cairn::app {

/// Text over the picture (Dear ImGui). At most one object at a time. It takes no input.
class Overlay {
public:
    explicit Overlay(GLFWwindow* window);
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;
    Overlay(Overlay&&) = delete;
    Overlay& operator=(Overlay&&) = delete;
    ~Overlay();

    /// @param line    text at the bottom
    /// @param notice  text above `line`, or empty
    void draw(const std::string& line, const std::string& notice, bool with_help) const;
};

}  // namespace cairn::app
