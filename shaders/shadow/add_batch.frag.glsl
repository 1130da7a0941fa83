// Adds the shares of the light that a batch of micro-patches hides to those of the batches before (Atty et
// al. 2005, appendix A).
#include "interop/shadow_map.h"

layout(binding = TEXTURE_SHADOW_HIDDEN) uniform sampler2D batch;
layout(location = 0) out float hidden;

void main() {
    hidden = texelFetch(batch, ivec2(gl_FragCoord.xy), 0).x;
}
