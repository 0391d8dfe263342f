package skein.lanes

import java.util.Arrays
import skein.scenario.Reduction

/** What a number comes to over the flights of many worlds. Mutable. */
private[lanes] final class LaneReduction(reduction: Reduction):
  private val worlds = TimetableAgents.WORLDS
  private var count  = 0

  /** The first value; of what is added up, sums and sums of squares of how far values are from it. */
  private val first, sums, squares = Array.ofDim[Float](worlds)

  def start(): Unit =
    count = 0
    Arrays.fill(sums, 0)
    Arrays.fill(squares, 0)

  /** Adds a value of every world. */
  def add(values: Array[Float], from: Int): Unit =
    count += 1
    if count == 1 then System.arraycopy(values, from, first, 0, worlds)
    else
      reduction match
        case Reduction.Least => least(values, from)
        case Reduction.Most  => most(values, from)
        case _               => addUp(values, from)

  private def least(values: Array[Float], from: Int): Unit =
    var i = 0
    while i < worlds do
      first(i) = Math.min(first(i), values(from + i))
      i += 1

  private def most(values: Array[Float], from: Int): Unit =
    var i = 0
    while i < worlds do
      first(i) = Math.max(first(i), values(from + i))
      i += 1

  private def addUp(values: Array[Float], from: Int): Unit =
    var i = 0
    while i < worlds do
      val off = values(from + i) - first(i)
      sums(i) += off
      squares(i) += off * off
      i += 1

  /** What it came to in a world; no number where nothing was added. */
  def value(world: Int): Float =
    val off      = sums(world).toDouble / count
    val mean     = first(world) + off
    val variance = (squares(world).toDouble / count - off * off).max(0)
    if count == 0 then Float.NaN
    else
      reduction match
        case Reduction.Least | Reduction.Most => first(world)
        case Reduction.Mean                   => mean.toFloat
        case Reduction.Rms                    => math.sqrt(variance + mean * mean).toFloat
        case Reduction.Sd                     => math.sqrt(variance).toFloat
