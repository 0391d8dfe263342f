package skein.gpu

import java.lang.foreign.ValueLayout.{ADDRESS, JAVA_INT, JAVA_LONG}
import java.lang.foreign.{Arena, FunctionDescriptor, Linker, MemoryLayout, SymbolLookup}
import java.lang.invoke.MethodHandle

/** Calls NVIDIA's driver (CUDA driver API 10.2 or later), which every machine with such a GPU has; no toolkit
  * is needed. Names are those of the API.
  *
  * @throws GpuFailure if the driver rejects a call, with the driver's message
  */
private[gpu] final class Cuda private (library: SymbolLookup):
  private val linker = Linker.nativeLinker

  private def function(name: String, arguments: MemoryLayout*): MethodHandle =
    val symbol = library.find(name).orElseThrow(() => GpuFailure(s"the driver has no $name; a newer one has"))
    linker.downcallHandle(symbol, FunctionDescriptor.of(JAVA_INT, arguments*))

  val init: MethodHandle               = function("cuInit", JAVA_INT)
  val deviceGetCount: MethodHandle     = function("cuDeviceGetCount", ADDRESS)
  val deviceGet: MethodHandle          = function("cuDeviceGet", ADDRESS, JAVA_INT)
  val deviceGetName: MethodHandle      = function("cuDeviceGetName", ADDRESS, JAVA_INT, JAVA_INT)
  val deviceGetAttribute: MethodHandle = function("cuDeviceGetAttribute", ADDRESS, JAVA_INT, JAVA_INT)
  val primaryCtxRetain: MethodHandle   = function("cuDevicePrimaryCtxRetain", ADDRESS, JAVA_INT)
  val ctxSetCurrent: MethodHandle      = function("cuCtxSetCurrent", ADDRESS)
  val ctxSynchronize: MethodHandle     = function("cuCtxSynchronize")
  val memAlloc: MethodHandle           = function("cuMemAlloc_v2", ADDRESS, JAVA_LONG)
  val memFree: MethodHandle            = function("cuMemFree_v2", JAVA_LONG)
  val memcpyHtoD: MethodHandle         = function("cuMemcpyHtoD_v2", JAVA_LONG, ADDRESS, JAVA_LONG)
  val memcpyDtoH: MethodHandle         = function("cuMemcpyDtoH_v2", ADDRESS, JAVA_LONG, JAVA_LONG)
  val moduleLoadDataEx: MethodHandle   =
    function("cuModuleLoadDataEx", ADDRESS, ADDRESS, JAVA_INT, ADDRESS, ADDRESS)
  val moduleUnload: MethodHandle      = function("cuModuleUnload", ADDRESS)
  val moduleGetFunction: MethodHandle = function("cuModuleGetFunction", ADDRESS, ADDRESS, ADDRESS)
  val launchKernel: MethodHandle      = function(
    "cuLaunchKernel",
    Vector(ADDRESS) ++ Vector.fill(7)(JAVA_INT) ++ Vector.fill(3)(ADDRESS)*
  )
  val eventCreate: MethodHandle      = function("cuEventCreate", ADDRESS, JAVA_INT)
  val eventRecord: MethodHandle      = function("cuEventRecord", ADDRESS, ADDRESS)
  val eventElapsedTime: MethodHandle = function("cuEventElapsedTime", ADDRESS, ADDRESS, ADDRESS)
  private val getErrorString         = function("cuGetErrorString", JAVA_INT, ADDRESS)

  def call(function: MethodHandle, arguments: Any*): Unit =
    val status = function.invokeWithArguments(arguments.map(_.asInstanceOf[AnyRef])*).asInstanceOf[Int]
    if status != 0 then throw GpuFailure(reasonOf(status))

  private def reasonOf(status: Int): String =
    val arena = Arena.ofConfined()
    try
      val text = arena.allocate(ADDRESS)
      val told = getErrorString.invokeWithArguments(status, text).asInstanceOf[Int] == 0
      val name = text.get(ADDRESS, 0)
      if told && name.address != 0 then s"${name.reinterpret(Cuda.MostChars).getString(0)} (error $status)"
      else s"error $status"
    finally arena.close()

private[gpu] object Cuda:
  private val MostChars = 4096L

  /** Loads the driver. Left says why that is impossible. */
  def load(): Either[String, Cuda] =
    val names = if scala.util.Properties.isWin then Seq("nvcuda.dll") else Seq("libcuda.so.1", "libcuda.so")
    names.iterator
      .flatMap(library)
      .nextOption()
      .toRight(s"no NVIDIA driver: the library ${names.head} is not found")
      .flatMap: found =>
        try Right(Cuda(found))
        catch case failure: GpuFailure => Left(failure.getMessage)

  private def library(name: String): Option[SymbolLookup] =
    try Some(SymbolLookup.libraryLookup(name, Arena.global))
    catch case _: (IllegalArgumentException | LinkageError) => None
