package skein.gpu

/** What a GPU's driver refuses.
  *
  * @param reason as it tells it
  */
final class GpuFailure(val reason: String) extends RuntimeException(s"the GPU: $reason")
