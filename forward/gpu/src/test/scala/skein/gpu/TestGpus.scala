package skein.gpu

import munit.FunSuite

/** Runs tests on an interpreter of a GPU's instructions, and on this machine's GPU if it has one. */
trait TestGpus:
  self: FunSuite =>

  private val found = CudaGpu.find()

  protected val gpus: Seq[(String, () => Gpu)] =
    ("interpreted" -> (() => InterpretedGpu())) +: found.toSeq.map(gpu => gpu.name -> (() => gpu))

  for why <- found.left do
    test("on this machine's GPU"):
      assume(false, why)
