package skein.gpu

/** What a GPU's driver refuses. */
final class GpuFailure(message: String) extends RuntimeException(s"the GPU: $message")
