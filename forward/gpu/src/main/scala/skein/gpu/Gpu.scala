package skein.gpu

/** A processor that runs one program in thousands of threads in parallel, for simulated flights. Kernels are
  * texts in PTX ([[Ptx]]). Callers take turns.
  */
trait Gpu:
  def name: String

  def ranNs: Long

  /** Translates a kernel for this GPU.
    *
    * @throws GpuFailure with the translator's complaint
    */
  private[skein] def kernel(module: String, name: String): GpuKernel

  /** Allocates memory for numbers of 4 bytes, until it is closed or unreachable.
    *
    * @throws GpuFailure if there is not enough
    */
  private[skein] def buffer(words: Long): GpuBuffer
  private[skein] def buffer(numbers: Array[Float]): GpuBuffer
  private[skein] def buffer(numbers: Array[Int]): GpuBuffer

/** An array of numbers in a GPU's memory, freed when closed. */
private[skein] trait GpuBuffer extends AutoCloseable:
  def address: Long

  /** Copies its contents.
    *
    * @throws GpuFailure if it cannot be copied
    */
  def floats(): Array[Float]
  def close(): Unit

/** A kernel, translated by the driver for its GPU. */
private[skein] trait GpuKernel:
  /** Runs it to its end.
    *
    * @param arguments in the kernel's order: a [[GpuBuffer]], an Int or a Float each
    * @throws GpuFailure if it does not finish
    */
  def apply(blocks: Int, threadsOfBlock: Int, arguments: Any*): Unit
