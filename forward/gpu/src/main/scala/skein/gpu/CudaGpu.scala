package skein.gpu

import java.lang.foreign.ValueLayout.{ADDRESS, JAVA_BYTE, JAVA_FLOAT, JAVA_INT, JAVA_LONG}
import java.lang.foreign.{Arena, MemorySegment}
import java.lang.invoke.MethodHandle
import java.lang.ref.Cleaner

/** An NVIDIA GPU, used through its driver. GPU memory is freed when its owner becomes unreachable.
  *
  * @param name the GPU's name, as reported by the driver
  */
private final class CudaGpu private (cuda: Cuda, context: MemorySegment, val name: String) extends Gpu:
  import CudaGpu.*

  private[skein] def kernel(module: String, name: String): GpuKernel = within: arena =>
    val log             = arena.allocate(MostLog)
    val options         = arena.allocateFrom(JAVA_INT, JitErrorLog, JitErrorLogBytes)
    val values          = arena.allocate(ADDRESS, 2)
    val loaded, located = arena.allocate(ADDRESS)
    values.setAtIndex(ADDRESS, 0, log)
    values.setAtIndex(ADDRESS, 1, MemorySegment.ofAddress(MostLog))
    try cuda.call(cuda.moduleLoadDataEx, loaded, arena.allocateFrom(module), 2, options, values)
    catch
      case refused: GpuFailure =>
        throw GpuFailure(s"${refused.reason} ${log.getString(0).trim}")
    val translated = loaded.get(ADDRESS, 0)
    cuda.call(cuda.moduleGetFunction, located, translated, arena.allocateFrom(name))
    val made = Kernel(located.get(ADDRESS, 0))
    givenBack(made)(cuda.moduleUnload, translated)
    made

  private var ran               = 0L
  private lazy val begins, ends = within: arena =>
    val event = arena.allocate(ADDRESS)
    cuda.call(cuda.eventCreate, event, 0)
    event.get(ADDRESS, 0)

  def ranNs: Long = ran

  private[skein] def buffer(words: Long): Buffer = within: arena =>
    val address = arena.allocate(JAVA_LONG)
    cuda.call(cuda.memAlloc, address, (words * 4).max(4))
    Buffer(address.get(JAVA_LONG, 0), words)

  private[skein] def buffer(numbers: Array[Float]): Buffer =
    val made = buffer(numbers.length)
    within(arena => made.write(arena.allocateFrom(JAVA_FLOAT, numbers*)))
    made

  private[skein] def buffer(numbers: Array[Int]): Buffer =
    val made = buffer(numbers.length)
    within(arena => made.write(arena.allocateFrom(JAVA_INT, numbers*)))
    made

  final class Buffer(val address: Long, words: Long) extends GpuBuffer:
    def write(from: MemorySegment): Unit = cuda.call(cuda.memcpyHtoD, address, from, from.byteSize)

    def floats(): Array[Float] = within: arena =>
      val here = arena.allocate(JAVA_FLOAT, words)
      cuda.call(cuda.memcpyDtoH, here, address, 4 * words)
      here.toArray(JAVA_FLOAT)

    private val memory = givenBack(this)(cuda.memFree, address)

    def close(): Unit = memory.clean()

  private final class Kernel(function: MemorySegment) extends GpuKernel:
    def apply(blocks: Int, threadsOfBlock: Int, arguments: Any*): Unit = within: arena =>
      val places = arena.allocate(ADDRESS, arguments.size.max(1))
      for (argument, i) <- arguments.zipWithIndex do
        val value = argument match
          case buffer: GpuBuffer => arena.allocateFrom(JAVA_LONG, buffer.address)
          case whole: Int        => arena.allocateFrom(JAVA_INT, whole)
          case other             => throw IllegalArgumentException(s"no kernel takes $other")
        places.setAtIndex(ADDRESS, i, value)
      val none = MemorySegment.NULL
      cuda.call(cuda.eventRecord, begins, none)
      cuda.call(cuda.launchKernel, function, blocks, 1, 1, threadsOfBlock, 1, 1, 0, none, places, none)
      cuda.call(cuda.eventRecord, ends, none)
      cuda.call(cuda.ctxSynchronize)
      val tookMs = arena.allocate(JAVA_FLOAT)
      cuda.call(cuda.eventElapsedTime, tookMs, begins, ends)
      ran += (tookMs.get(JAVA_FLOAT, 0) * 1e6).toLong

  /** Registers a driver's resource, which is released when it is closed or when its owner becomes
    * unreachable.
    */
  private def givenBack(holder: AnyRef)(by: MethodHandle, what: Any): Cleaner.Cleanable =
    cleaner.register(
      holder,
      () =>
        // After a fault the driver refuses this too; then nothing is left to free.
        try within(_ => cuda.call(by, what))
        catch case _: GpuFailure => ()
    )

  private def within[A](body: Arena => A): A = synchronized:
    val arena = Arena.ofConfined()
    try
      cuda.call(cuda.ctxSetCurrent, context)
      body(arena)
    finally arena.close()

/** Finds the NVIDIA GPUs of this machine through the driver. */
object CudaGpu:
  private val MostLog          = 8192L
  private val JitErrorLog      = 5
  private val JitErrorLogBytes = 6
  private val MostName         = 256
  private val cleaner          = Cleaner.create()

  // CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR and _MINOR, and the least ones that the PTX needs (Turing).
  private val Capability      = (75, 76)
  private val LeastCapability = (7, 5)

  /** The first GPU of this machine; every call returns one object.
    *
    * @return Left says why there is none
    */
  def find(): Either[String, Gpu] = first

  private lazy val first: Either[String, Gpu] = Cuda.load().flatMap: cuda =>
    val arena = Arena.ofConfined()
    try
      val number, device = arena.allocate(JAVA_INT)
      val name           = arena.allocate(JAVA_BYTE, MostName)
      val context        = arena.allocate(ADDRESS)
      cuda.call(cuda.init, 0)
      cuda.call(cuda.deviceGetCount, number)
      if number.get(JAVA_INT, 0) == 0 then Left("the NVIDIA driver knows of no GPU")
      else
        cuda.call(cuda.deviceGet, device, 0)
        cuda.call(cuda.deviceGetName, name, MostName, device.get(JAVA_INT, 0))
        def attribute(which: Int): Int =
          cuda.call(cuda.deviceGetAttribute, number, which, device.get(JAVA_INT, 0))
          number.get(JAVA_INT, 0)
        val (major, minor)           = (attribute(Capability._1), attribute(Capability._2))
        val (leastMajor, leastMinor) = LeastCapability
        if Ordering[(Int, Int)].lt((major, minor), LeastCapability) then
          Left(
            s"expected an NVIDIA GPU of compute capability $leastMajor.$leastMinor at least, " +
              s"found ${name.getString(0)} of $major.$minor"
          )
        else
          cuda.call(cuda.primaryCtxRetain, context, device.get(JAVA_INT, 0))
          Right(new CudaGpu(cuda, context.get(ADDRESS, 0), name.getString(0)))
    catch case refused: GpuFailure => Left(refused.getMessage)
    finally arena.close()
