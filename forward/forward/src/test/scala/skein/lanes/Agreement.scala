package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.formula.{ErrorBound, Node}

/** Compares SIMD worlds with the scalar engine. In every world both must make equal decisions, until a
  * compared number is so near to a threshold that rounding decides, as [[ErrorBound]] shows; after that, the
  * world may differ.
  */
private[skein] final class Agreement:
  import Agreement.*
  private var same             = 0
  private val undecided, wrong = ArrayBuffer.empty[(Int, Departure)]

  /** Adds a world.
    *
    * @param first the first decision that differs
    * @param whereSame compares the flights if no decision differs
    */
  def add(world: Int, first: Option[Departure])(whereSame: => Unit): Unit = first match
    case None                                   => same += 1; whereSame
    case Some(departure) if departure.isRounded => undecided += world -> departure
    case Some(departure)                        => wrong += world     -> departure

  /** Checks all added worlds.
    *
    * @param atLeast minimum number of worlds with equal decisions to the end, so that enough is compared
    */
  def check(what: String, atLeast: Int = 1)(using munit.Location): Unit =
    def told(departures: Iterable[(Int, Departure)]) =
      departures.take(Told).map((world, departure) => s"  world $world: $departure\n").mkString
    if wrong.nonEmpty || same < atLeast then
      munit.Assertions.fail(
        s"$what: $same worlds the same, at least $atLeast expected\n" +
          s"${wrong.size} differ at no threshold:\n${told(wrong)}" +
          s"${undecided.size} at a threshold:\n${told(undecided)}"
      )

private[skein] object Agreement:
  private val Told = 5

  /** Maximum rounding error of floats that accumulates in the vehicles' motion until a time, m and m/s. It
    * applies until decisions differ. At 500 m a float is rounded by up to 3e-5 m, here a dozen times per
    * second.
    */
  def mostOff(timeS: Double): Double = 1e-3 + 4e-4 * timeS

  /** A decision of the SIMD engine that differs from the decision of the scalar engine.
    *
    * @param apart for each output its error, and the bound on the error if each comparison near its threshold
    *   had the other result
    * @param near comparisons so near to their thresholds that rounding decides, with their distances
    */
  final case class Departure(
      agent: Int,
      decision: Int,
      timeS: Double,
      apart: Vector[(Double, Double)],
      near: Vector[(Node, Double)]
  ):
    def isRounded: Boolean = near.nonEmpty && apart.forall((by, most) => by <= most)

    override def toString: String =
      s"agent $agent, decision $decision, at $timeS s: " +
        apart.map((by, most) => s"$by off, bound $most").mkString("; ") +
        (if near.isEmpty then ", near no threshold"
         else
           near.sortBy(_._2).take(Told).map((node, by) => s", $by from ${node.toString.take(200)}").mkString)

  /** The outputs that differ by more than floats allow with equal branches.
    *
    * @param off error of each input
    * @param ours the SIMD results, in the order of the nodes
    * @param between difference of two values of an output, from its number
    */
  def departure(
      agent: Int,
      decision: Int,
      timeS: Double,
      nodes: Vector[Node],
      inputs: Array[Double],
      off: Array[Double],
      parameters: Array[Double],
      ours: Vector[Double],
      between: (Int, Double, Double) => Double = (_, a, b) => math.abs(a - b)
  ): Option[Departure] =
    def apart(most: ErrorBound) = nodes.indices.toVector.map: i =>
      (between(i, ours(i), most.value(nodes(i))), most.error(nodes(i)))
    val taken = ErrorBound.of(nodes, inputs, off, parameters, sameWay = true)
    Option.when(apart(taken).exists((by, most) => !(by <= most))):
      val either = ErrorBound.of(nodes, inputs, off, parameters)
      Departure(agent, decision, timeS, apart(either), either.undecided(nodes))
