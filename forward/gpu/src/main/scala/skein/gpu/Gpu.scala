package skein.gpu

/** A processor that runs a program in thousands of parallel threads, for simulated flights. Kernels are PTX
  * texts ([[Ptx]]). Several threads may use it; they take turns.
  */
trait Gpu:
  def name: String

  def ranNs: Long

  /** Translates a kernel for this GPU.
    *
    * @throws GpuFailure with the translator's message, if it rejects the kernel
    */
  private[skein] def kernel(module: String, name: String): GpuKernel

  /** Allocates memory for numbers of 4 bytes. It is freed when the buffer is closed or unreachable.
    *
    * @throws GpuFailure if there is not enough memory
    */
  private[skein] def buffer(words: Long): GpuBuffer
  private[skein] def buffer(numbers: Array[Float]): GpuBuffer
  private[skein] def buffer(numbers: Array[Int]): GpuBuffer

/** An array of numbers in the memory of a GPU; freed when closed. */
private[skein] trait GpuBuffer extends AutoCloseable:
  def address: Long

  /** Copies the array from the GPU.
    *
    * @throws GpuFailure if that fails
    */
  def floats(): Array[Float]
  def close(): Unit

/** A kernel that the driver has translated for its GPU. */
private[skein] trait GpuKernel:
  /** Runs the kernel to its end.
    *
    * @param arguments the arguments in the kernel's order, each a [[GpuBuffer]] or an Int
    * @throws GpuFailure if the kernel does not finish
    */
  def apply(blocks: Int, threadsOfBlock: Int, arguments: Any*): Unit
