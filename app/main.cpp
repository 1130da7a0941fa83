#include <algorithm>

#include "app/command_line.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/terminal.h"

int main(int argc, char** argv) {
    cairn::app::secure_standard_streams();
    try {
        const cairn::app::Interrupt interrupt;
        return int(cairn::app::read_command_line({argv + std::min(argc, 1), argv + argc})());
    } catch (...) {
        return int(cairn::app::report_current_exception());
    }
}
