#include "gl/timer.h"

#include <glad/gl.h>

namespace cairn::gl {
namespace {

QueryHandle make_timestamp() {
    GLuint id = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &id);
    return QueryHandle(id);
}

GLuint64 nanoseconds_of(const QueryHandle& query) {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query.id(), GL_QUERY_RESULT, &nanoseconds);
    return nanoseconds;
}

}  // namespace

Timer::Timer() : begin_(make_timestamp()), end_(make_timestamp()) {}

void Timer::start() const {
    glQueryCounter(begin_.id(), GL_TIMESTAMP);
}
void Timer::stop() const {
    glQueryCounter(end_.id(), GL_TIMESTAMP);
}

double Timer::milliseconds() const {
    const GLuint64 begin = nanoseconds_of(begin_);
    const GLuint64 end = nanoseconds_of(end_);
    return end > begin ? double(end - begin) * 1e-6 : 0.0;
}

}  // namespace cairn::gl
