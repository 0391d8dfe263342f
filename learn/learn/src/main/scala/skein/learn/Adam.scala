package skein.learn

import java.io.{DataInput, DataOutput}
import skein.units.eachBelow

/** Adam: gradient steps, each parameter's with its own scale. Source: Kingma and Ba, "Adam: a method for
  * stochastic optimization", 2015, algorithm 1, with their defaults.
  */
final class Adam(size: Int, val rate: Double) extends Saved:
  private val mean    = Array.ofDim[Float](size)
  private val squares = Array.ofDim[Float](size)
  private var steps   = 0L

  def step(parameters: Array[Float], gradient: Array[Float]): Unit =
    steps += 1
    val (m, v)       = (mean, squares)
    val unbiasMean   = 1 - StrictMath.pow(Adam.MeanDecay, steps.toDouble)
    val unbiasRoot   = math.sqrt(1 - StrictMath.pow(Adam.SquaresDecay, steps.toDouble))
    val by           = (rate * unbiasRoot / unbiasMean).toFloat
    val small        = (Adam.Small * unbiasRoot).toFloat
    val (b1, b2)     = (Adam.MeanDecay.toFloat, Adam.SquaresDecay.toFloat)
    val (new1, new2) = ((1 - Adam.MeanDecay).toFloat, (1 - Adam.SquaresDecay).toFloat)
    eachBelow(size): i =>
      val g = gradient(i)
      m(i) = b1 * m(i) + new1 * g
      v(i) = b2 * v(i) + new2 * g * g
      parameters(i) = parameters(i) - by * m(i) / (Math.sqrt(v(i).toDouble).toFloat + small)

  def save(out: DataOutput): Unit =
    out.writeLong(steps)
    Saved.write(out, mean)
    Saved.write(out, squares)

  def load(in: DataInput): Unit =
    steps = in.readLong()
    Saved.read(in, mean)
    Saved.read(in, squares)

object Adam:
  private val MeanDecay    = 0.9
  private val SquaresDecay = 0.999
  private val Small        = 1e-8
