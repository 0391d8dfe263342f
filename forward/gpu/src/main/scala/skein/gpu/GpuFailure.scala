package skein.gpu

/** A GPU's driver has rejected a call.
  *
  * @param reason in the driver's words
  */
final class GpuFailure(val reason: String) extends RuntimeException(s"the GPU: $reason")
