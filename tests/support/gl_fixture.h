#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "gl/context.h"

namespace cairn::test {

/// A test with an OpenGL context of its own and KHR_debug on. It fails if OpenGL has reported an error or
/// undefined behaviour that the test has not taken out of the log.
class GlTest : public ::testing::Test {
protected:
    void SetUp() override {
        context_ = gl::create_context({.kind = gl::ContextKind::automatic, .debug = true});
    }
    void TearDown() override {
        for (const std::string& message : context_->debug_log().take())
            ADD_FAILURE() << "OpenGL: " << message;
    }

    [[nodiscard]] gl::Context& context() { return *context_; }

private:
    std::unique_ptr<gl::Context> context_;
};

}  // namespace cairn::test
