package skein.lanes.gpu

import skein.forward.RolloutAgent
import skein.gpu.{Gpu, Ptx, PtxExpressions}
import skein.lanes.PreparedTeam
import skein.lanes.policy.TeamLanes
import skein.lanes.score.ScoreLanes
import skein.simd.BoundFunction

/** Simulates teams on a GPU. All vehicles are one side: for each vehicle the start, the initial direction and
  * the values of its policy; then the parameters of each quantity.
  *
  * @param vehicles the vehicles of one candidate; other candidates' starts and headings are in their sides
  */
private[lanes] final class GpuTeamKernel(
    gpu: Gpu,
    vehicles: Vector[RolloutAgent],
    vehicle: GpuVehicle.Kind,
    prediction: Option[GpuPrediction.Kind],
    team: TeamLanes,
    scores: ScoreLanes,
    layout: GpuLayout
) extends GpuFlightKernel(gpu, layout, Vector(GpuTeamKernel.numbers(team, scores)), scores, vehicles):
  import GpuTeamKernel.*
  private val firstDirection = layout.bytes
  private val firstShared    = firstDirection + 8 * team.count

  override protected def moreBytes: Int = firstShared + 4 * team.shared.outputs - layout.bytes

  protected val withVelocity: Boolean = team.needsVelocity

  def sidesOf(teams: Array[PreparedTeam]): Vector[(Array[Float], Array[Int])] =
    Vector((teams.flatMap(numbersOf), teams.indices.toArray))

  protected def body(code: Ptx, numbers: Vector[Int => Int]): Body = new Body:
    private val number        = numbers(0)
    private val first         = firstOf(team)
    private val firstQuantity = first.last

    val vehicles: Vector[GpuVehicle] = GpuTeamKernel.this.vehicles.zipWithIndex.map: (agent, self) =>
      vehicle(code, agent.copy(speed = 1), number(first(self)), number(first(self) + 1))

    val predictions: Vector[GpuPrediction] =
      prediction.toVector.flatMap(of =>
        GpuTeamKernel.this.vehicles.map(each => of(code, each.copy(speed = 1)))
      )

    private def direction(self: Int) = code.own(code.whole(firstDirection + 8 * self))
    private lazy val shared          = code.own(code.whole(firstShared))

    def start(): Unit =
      shared: Unit
      for self <- 0 until team.count; i <- 0 to 1 do
        code.storeOwn(number(first(self) + 2 + i), direction(self), i)

    def show(now: GpuRecord): Unit = if team.shared.outputs > 0 then
      val values = write(team.shared, now, -1)
      for (value, i) <- values.zipWithIndex do code.storeOwn(value, shared, i)

    def decide(self: Int, now: GpuRecord): Unit =
      val decided = write(team.functions(self), now, self)
      val after   = now.place(4)
      val heads   = direction(self)
      for i <- 0 to 1 do
        code.storeOwn(decided(i), after, i)
        code.storeOwn(decided(2 + i), heads, i)

    private def write(bound: BoundFunction, now: GpuRecord, self: Int): Vector[Int] =
      import TeamLanes.Source
      val seen = now.seen()
      PtxExpressions.write(code, bound.nodes)(
        place =>
          val input = bound.inputs(place)
          team.reading(input) match
            case Some((vehicle, field)) => code.loadOwn(seen(vehicle), field)
            case None                   =>
              team.source(input) match
                case Source.Cos              => code.loadOwn(direction(self), 0)
                case Source.Sin              => code.loadOwn(direction(self), 1)
                case Source.Elapsed          => now.time(0)
                case Source.Parameter(which) => number(first(self) + Starts + which)
                case Source.Shared(which)    => code.loadOwn(shared, which)
                case other                   => throw IllegalStateException(s"a GPU does not know $other")
        ,
        which => throw IllegalStateException(s"a team's functions have no parameter $which")
      )

    def quantity(of: Int, parameter: Int): Int =
      number(firstQuantity + (0 until of).map(scores.parameters).sum + parameter)

private object GpuTeamKernel:
  /** Number of values of a vehicle's start: north and east, m, and cosine and sine of its heading. */
  private val Starts = 4

  /** Offset of each vehicle's values in a side; the last entry is that of the quantities' parameters. */
  private def firstOf(team: TeamLanes): Vector[Int] =
    Vector.range(0, team.count).scanLeft(0)((first, self) => first + Starts + team.parameters(self))

  private def numbers(team: TeamLanes, scores: ScoreLanes): Int =
    firstOf(team).last + scores.judged.indices.map(scores.parameters).sum

  private def numbersOf(team: PreparedTeam): Array[Float] =
    team.numbers.flatMap(own => Array(own.northM, own.eastM, own.cos, own.sin) ++ own.policy) ++
      team.ofScores.flatten.map(_.toFloat)
