package skein.gpu

/** Thrown when a GPU's driver rejects a call.
  *
  * @param reason the driver's message
  */
final class GpuFailure(val reason: String) extends RuntimeException(s"the GPU: $reason")
