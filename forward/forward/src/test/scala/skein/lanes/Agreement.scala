package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.formula.{ErrorBound, Node}

/** Worlds that fly by lanes and by the scalar engine. Both take the same decisions in each, but where a
  * number that is compared lies so near to a threshold that rounding decides: [[ErrorBound]] says how near
  * that is. From there on a world may fly otherwise.
  */
private[skein] final class Agreement:
  import Agreement.*
  private var same             = 0
  private val undecided, wrong = ArrayBuffer.empty[(Int, Departure)]

  /** Adds a world.
    *
    * @param first what the two decided otherwise first
    * @param whereSame holds the flights together, if there is nothing
    */
  def add(world: Int, first: Option[Departure])(whereSame: => Unit): Unit = first match
    case None                                   => same += 1; whereSame
    case Some(departure) if departure.isRounded => undecided += world -> departure
    case Some(departure)                        => wrong += world     -> departure

  /** @param atLeast so many worlds take the same decisions from begin to end, or else nothing was compared
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

  /** What floats add up to in the vehicles' flight until a time, m and m/s: until decisions part, vehicles
    * are where they are in doubles. At 500 m a float is rounded by up to 3e-5 m, here a dozen times a second.
    */
  def mostOff(timeS: Double): Double = 1e-3 + 4e-4 * timeS

  /** What lanes decided otherwise than the scalar engine.
    *
    * @param apart by output: how far off, and how far it may be if each comparison near its threshold went
    *   the other way
    * @param near comparisons so near to their thresholds that rounding decides, with how near
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

  /** Where outputs differ by more than floats may that decide as doubles do.
    *
    * @param off how far each input is
    * @param ours of the lanes, in the nodes' order
    * @param between how far two values of an output are apart, by its number
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
