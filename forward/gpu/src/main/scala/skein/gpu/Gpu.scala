package skein.gpu

/** A processor that runs one program in many threads at once, for flights by the thousand. Kernels are texts
  * in PTX ([[Ptx]]). Callers take turns.
  */
trait Gpu:
  /** As its driver tells it. */
  def name: String

  /** How long kernels ran so far, ns. */
  def ranNs: Long

  /** Translates a kernel for this GPU.
    *
    * @throws GpuFailure with the translator's complaint
    */
  private[skein] def kernel(module: String, name: String): GpuKernel

  /** Memory for so many numbers of 4 bytes, until it is closed or nobody knows it.
    *
    * @throws GpuFailure if there is not so much
    */
  private[skein] def buffer(words: Long): GpuBuffer
  private[skein] def buffer(numbers: Array[Float]): GpuBuffer
  private[skein] def buffer(numbers: Array[Int]): GpuBuffer

/** Memory of a GPU. */
private[skein] trait GpuBuffer extends AutoCloseable:
  def address: Long

  /** What stands in it.
    *
    * @throws GpuFailure if it cannot be copied
    */
  def floats(): Array[Float]
  def close(): Unit

/** A translated kernel. */
private[skein] trait GpuKernel:
  /** Runs it to its end.
    *
    * @param arguments in the kernel's order: a [[GpuBuffer]], an Int or a Float each
    * @throws GpuFailure if it does not come to its end
    */
  def apply(blocks: Int, threadsOfBlock: Int, arguments: Any*): Unit
