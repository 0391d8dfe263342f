package skein.planning

import java.util.Arrays
import skein.lanes.policy.PolicyLanes
import skein.vehicle.PlaneReading

/** A [[Target.Opponent]] against each of a block's candidates: it decides at every step by its policy,
  * compiled from the policy itself. [[ManoeuvreRollout]] is the scalar reference. Mutable.
  */
private[planning] final class OpponentLanes(steps: Int):
  import OpponentLanes.*

  private var opponent = Option.empty[Target.Opponent]
  private var decision = Option.empty[Decision]

  /** Sets the opponent to simulate; the policy must be a formula. */
  def take(opponent: Target.Opponent): Unit = if !this.opponent.exists(_ eq opponent) then
    this.opponent = Some(opponent)
    val form = PolicyLanes.get(opponent.policy)
    val made = decision.filter(_.form eq form).getOrElse(Decision(form))
    made.take(opponent.policy)
    decision = Some(made)

  /** Simulates all steps.
    *
    * @param own the candidates' tracks
    * @param cos cosines of the headings commanded to them before each step; `sin` likewise
    * @param into receives the opponent's tracks
    */
  def fly(
      own: VehicleLanes,
      cos: Array[Float],
      sin: Array[Float],
      origin: PlaneReading,
      dtS: Double,
      into: VehicleLanes
  ): Unit =
    for opponent <- opponent; decision <- decision do
      into.take(opponent.vehicle, origin, dtS)
      decision.begin(opponent, dtS)
      val speed = opponent.speed.toFloat
      for step <- 0 until steps do
        decision(own, into, cos, sin, step)
        into.fly(decision.cos, decision.sin, speed)

private object OpponentLanes:
  private final val Size = CandidateBlock.Size

  /** Decisions of policies of one form. Each begins with the previous decision. */
  private final class Decision(val form: PolicyLanes):
    import PolicyLanes.In
    private val function = form.functionOfOne
    private val scratch  = Array.ofDim[Float](function.scratch)
    private val count    = form.courseOutputs
    private val inputs   = form.inputs
    private val arrays  = Array.fill(inputs + count)(Array.ofDim[Float](Size)) ++ Array.ofDim[Array[Float]](4)
    private val offsets = Array.ofDim[Int](arrays.length)
    private var parameters = Array.emptyFloatArray

    def cos: Array[Float] = arrays(In.OwnCos)
    def sin: Array[Float] = arrays(In.OwnSin)

    def take(policy: skein.policy.Policy): Unit = parameters = form.parametersOf(policy).map(_.toFloat)

    def begin(opponent: Target.Opponent, dtS: Double): Unit =
      def fill(input: Int, value: Double) = Arrays.fill(arrays(input), value.toFloat)
      fill(In.Elapsed, dtS)
      fill(In.OwnCos, StrictMath.cos(opponent.headingRad))
      fill(In.OwnSin, StrictMath.sin(opponent.headingRad))
      fill(In.Heading, StrictMath.IEEEremainder(opponent.headingRad, 2 * math.Pi))
      for (number, i) <- form.initialOf(opponent.policy).zipWithIndex do fill(In.Memory + i, number)

    def apply(
        seen: VehicleLanes,
        own: VehicleLanes,
        seenCos: Array[Float],
        seenSin: Array[Float],
        step: Int
    ): Unit =
      reading(0, seen, step)
      reading(inputs + count, own, step)
      put(In.KnownCos, seenCos, step * Size)
      put(In.KnownSin, seenSin, step * Size)
      function(arrays, offsets, parameters, scratch)
      swap(In.OwnCos, 0)
      swap(In.OwnSin, 1)
      for i <- 0 until form.memories do swap(In.Memory + i, 2 + i)
      if form.keepsHeading then swap(In.Heading, count - 1)

    private def reading(first: Int, vehicle: VehicleLanes, step: Int): Unit =
      put(first, vehicle.way, VehicleLanes.row(step, 0))
      put(first + 1, vehicle.way, VehicleLanes.row(step, 1))
      put(first + 2, vehicle.way, VehicleLanes.row(step, 2))
      put(first + 3, vehicle.way, VehicleLanes.row(step, 3))

    private def put(number: Int, array: Array[Float], at: Int): Unit =
      arrays(number) = array
      offsets(number) = at

    private def swap(input: Int, output: Int): Unit =
      val before = arrays(input)
      arrays(input) = arrays(inputs + output)
      arrays(inputs + output) = before
