#include "gl/timer.h"

namespace cairn::gl {

Timer::Timer() {
    GLuint id = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &id);
    query_ = QueryHandle(id);
}

void Timer::start() const {
    glBeginQuery(GL_TIME_ELAPSED, query_.id());
}
void Timer::stop() const {
    glEndQuery(GL_TIME_ELAPSED);
}

double Timer::milliseconds() const {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query_.id(), GL_QUERY_RESULT, &nanoseconds);
    return double(nanoseconds) * 1e-6;
}

}  // namespace cairn::gl
