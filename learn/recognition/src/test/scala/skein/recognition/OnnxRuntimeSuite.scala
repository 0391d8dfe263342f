package skein.recognition

import java.nio.file.{Files, Path}

class OnnxRuntimeSuite extends munit.FunSuite:

  private def told(error: LinkageError) = OnnxRuntime.present(throw error)

  test("without onnxruntime, the message shows how to add it, as the guide does, and names no class"):
    val text = told(NoClassDefFoundError("ai/onnxruntime/OrtException")).swap.getOrElse(fail("it is there"))
    assert(!clue(text).contains("ai/") && !text.contains("java.lang"))
    val guide = Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).takeWhile(_ != null)
      .map(_.resolve("docs/guides/onnx.md")).find(Files.exists(_)).map(Files.readString).getOrElse(fail(
        "no guide"
      ))
    for command <- Seq(OnnxRuntime.Fetch, OnnxRuntime.Use) do
      assert(text.contains(command) && guide.contains(command), command)

  test("an onnxruntime that does not start on this machine is reported as such"):
    assertEquals(
      told(ExceptionInInitializerError(UnsatisfiedLinkError("no libonnxruntime.so"))),
      Left("onnxruntime, which runs models, cannot be loaded on this machine: no libonnxruntime.so")
    )
