// The OpenGL 3.3 core functions that the renderer calls, looked up from whatever context is current.
#pragma once

#include <GL/glcorearb.h>

namespace burin::gl {

// One line per function: type suffix, name without "gl".
#define BURIN_GL_FUNCTIONS(F)                        \
    F(GETSTRING, GetString)                          \
    F(GETERROR, GetError)                            \
    F(GETINTEGERV, GetIntegerv)                      \
    F(CREATESHADER, CreateShader)                    \
    F(SHADERSOURCE, ShaderSource)                    \
    F(COMPILESHADER, CompileShader)                  \
    F(GETSHADERIV, GetShaderiv)                      \
    F(GETSHADERINFOLOG, GetShaderInfoLog)            \
    F(DELETESHADER, DeleteShader)                    \
    F(CREATEPROGRAM, CreateProgram)                  \
    F(ATTACHSHADER, AttachShader)                    \
    F(LINKPROGRAM, LinkProgram)                      \
    F(GETPROGRAMIV, GetProgramiv)                    \
    F(GETPROGRAMINFOLOG, GetProgramInfoLog)          \
    F(DELETEPROGRAM, DeleteProgram)                  \
    F(USEPROGRAM, UseProgram)                        \
    F(GETUNIFORMLOCATION, GetUniformLocation)        \
    F(UNIFORM1I, Uniform1i)                          \
    F(UNIFORM1F, Uniform1f)                          \
    F(UNIFORM2I, Uniform2i)                          \
    F(UNIFORM2F, Uniform2f)                          \
    F(UNIFORM3F, Uniform3f)                          \
    F(UNIFORM4F, Uniform4f)                          \
    F(UNIFORM4I, Uniform4i)                          \
    F(UNIFORMMATRIX4FV, UniformMatrix4fv)            \
    F(GENTEXTURES, GenTextures)                      \
    F(DELETETEXTURES, DeleteTextures)                \
    F(BINDTEXTURE, BindTexture)                      \
    F(ACTIVETEXTURE, ActiveTexture)                  \
    F(TEXIMAGE2D, TexImage2D)                        \
    F(TEXIMAGE3D, TexImage3D)                        \
    F(TEXPARAMETERI, TexParameteri)                  \
    F(TEXPARAMETERFV, TexParameterfv)                \
    F(GENERATEMIPMAP, GenerateMipmap)                \
    F(PIXELSTOREI, PixelStorei)                      \
    F(GENBUFFERS, GenBuffers)                        \
    F(DELETEBUFFERS, DeleteBuffers)                  \
    F(BINDBUFFER, BindBuffer)                        \
    F(BUFFERDATA, BufferData)                        \
    F(GENVERTEXARRAYS, GenVertexArrays)              \
    F(DELETEVERTEXARRAYS, DeleteVertexArrays)        \
    F(BINDVERTEXARRAY, BindVertexArray)              \
    F(VERTEXATTRIBPOINTER, VertexAttribPointer)      \
    F(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
    F(GENFRAMEBUFFERS, GenFramebuffers)              \
    F(DELETEFRAMEBUFFERS, DeleteFramebuffers)        \
    F(BINDFRAMEBUFFER, BindFramebuffer)              \
    F(GENRENDERBUFFERS, GenRenderbuffers)            \
    F(DELETERENDERBUFFERS, DeleteRenderbuffers)      \
    F(BINDRENDERBUFFER, BindRenderbuffer)            \
    F(RENDERBUFFERSTORAGE, RenderbufferStorage)      \
    F(RENDERBUFFERSTORAGEMULTISAMPLE, RenderbufferStorageMultisample) \
    F(BLITFRAMEBUFFER, BlitFramebuffer)              \
    F(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) \
    F(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D)    \
    F(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) \
    F(DRAWBUFFERS, DrawBuffers)                      \
    F(READBUFFER, ReadBuffer)                        \
    F(READPIXELS, ReadPixels)                        \
    F(VIEWPORT, Viewport)                            \
    F(ENABLE, Enable)                                \
    F(DISABLE, Disable)                              \
    F(CULLFACE, CullFace)                            \
    F(CLEARCOLOR, ClearColor)                        \
    F(CLEAR, Clear)                                  \
    F(DRAWARRAYS, DrawArrays)                        \
    F(DRAWELEMENTS, DrawElements)                    \
    F(FINISH, Finish)

struct Functions {
#define BURIN_GL_MEMBER(type, name) PFNGL##type##PROC name = nullptr;
    BURIN_GL_FUNCTIONS(BURIN_GL_MEMBER)
#undef BURIN_GL_MEMBER
};

}  // namespace burin::gl
