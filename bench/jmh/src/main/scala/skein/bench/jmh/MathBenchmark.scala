package skein.bench.jmh

import org.openjdk.jmh.annotations.*
import skein.bench.{Atan2, SinCos}
import skein.simd.LaneMath

/** Elementary functions on SIMD floats beside `StrictMath`'s on doubles, which decide scalar flights:
  * millions of numbers a second, on one thread.
  */
class MathBenchmark extends Rate:
  private val numbers = Array.tabulate(1024)(i => (i - 512) / 200f)
  private val others  = numbers.reverse
  private val into    = new Array[Float](1024)
  private val second  = new Array[Float](1024)
  private var sum     = 0.0

  @TearDown
  def show(): Unit = println(f"witness, sum of what was computed last: $sum%.4f")

  @Benchmark
  @OperationsPerInvocation(1024)
  def sinCosByLanes(): Array[Float] =
    SinCos.sinCos(numbers, into, second, 1024)
    witnessed()

  @Benchmark
  @OperationsPerInvocation(1024)
  def sinCosStrict(): Array[Float] =
    for i <- 0 until 1024 do
      into(i) = StrictMath.sin(numbers(i).toDouble).toFloat
      second(i) = StrictMath.cos(numbers(i).toDouble).toFloat
    witnessed()

  @Benchmark
  @OperationsPerInvocation(1024)
  def atan2ByLanes(): Array[Float] =
    Atan2.atan2(numbers, others, into, 1024)
    witnessed()

  @Benchmark
  @OperationsPerInvocation(1024)
  def atan2Strict(): Array[Float] =
    for i <- 0 until 1024 do into(i) = StrictMath.atan2(numbers(i).toDouble, others(i).toDouble).toFloat
    witnessed()

  /** `exp` with SIMD, in place: the numbers are copied first. */
  @Benchmark
  @OperationsPerInvocation(1024)
  def expByLanes(): Array[Float] =
    System.arraycopy(numbers, 0, into, 0, 1024)
    LaneMath.exp(into, 0, 1024)
    witnessed()

  @Benchmark
  @OperationsPerInvocation(1024)
  def expStrict(): Array[Float] =
    for i <- 0 until 1024 do into(i) = StrictMath.exp(numbers(i).toDouble).toFloat
    witnessed()

  private def witnessed(): Array[Float] =
    sum = into(1) + into(1000) + second(1) + second(1000)
    into
