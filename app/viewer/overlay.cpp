#include "app/viewer/overlay.h"

#include <array>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace cairn::app {
namespace {

constexpr ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_AlwaysAutoResize;
constexpr float backdrop = 0.65F;
constexpr float margin = 8.0F;

struct Control {
    const char* input;
    const char* effect;
};
constexpr std::array controls = {
    Control{"left drag", "orbit; look around when flying"},
    Control{"right, middle drag", "pan"},
    Control{"wheel", "zoom; speed when flying"},
    Control{"F", "fly, or orbit again"},
    Control{"W A S D Q E", "fly ahead, left, back, right, down, up"},
    Control{"R, Home", "first camera"},
    Control{"L", "surface, tree levels, bricks"},
    Control{"H", "shadows on, off"},
    Control{"[ ] or + -", "voxels finer, coarser"},
    Control{"P", "write a PNG of the converged picture"},
    Control{"F1, ?", "this help"},
    Control{"Escape", "leave"},
};

void draw_help() {
    ImGui::SetNextWindowPos({margin, margin});
    ImGui::SetNextWindowBgAlpha(backdrop);
    if (ImGui::Begin("help", nullptr, plain) &&
        ImGui::BeginTable("controls", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const Control& control : controls) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(control.input);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(control.effect);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace

Overlay::Overlay(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // no file with the state of windows
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOpenGL(window, false);
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

Overlay::~Overlay() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Overlay::draw(const std::string& line, const std::string& notice, bool with_help) const {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (with_help) draw_help();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({margin, size.y - margin}, ImGuiCond_Always, {0.0F, 1.0F});
    ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, {size.x - 2.0F * margin, size.y});
    ImGui::SetNextWindowBgAlpha(backdrop);
    if (ImGui::Begin("line", nullptr, plain)) {
        ImGui::PushTextWrapPos(size.x - 4.0F * margin);
        if (!notice.empty()) ImGui::TextUnformatted(notice.c_str());
        ImGui::TextUnformatted(line.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace cairn::app
