package skein.lanes

import skein.forward.{Duel, Duelist}
import skein.gpu.{Gpu, GpuBuffer, GpuKernel, Ptx, PtxExpressions, Variables}
import skein.policy.Policy
import skein.scenario.Reduction

/** [[TimetableKernel]] on a GPU, for duels: a thread flies one candidate through one episode, and the threads
  * of a block fly candidates of the same. So no two threads of a block part ways. What is computed are the
  * same expressions by the same single operations as on the CPU, and so the outcomes, to the bit.
  *
  * @param duel start, speeds and duration
  * @param readings places that the readings of one vehicle need at most, and so for headings
  */
private[lanes] final class GpuDuelKernel(
    gpu: Gpu,
    duel: Duel,
    periodS: Double,
    vehicle: (Ptx, Duelist) => GpuVehicle,
    forms: GpuDuelKernel.Forms,
    asked: Set[DuelNumber],
    layout: GpuLayout
):
  import GpuDuelKernel.*

  private val duelists     = Vector(duel.evader, duel.pursuer)
  private val policies     = Vector(forms.evader, forms.pursuer)
  private val judged       = DuelKernel.judged(duel.durationS, periodS, asked)
  private val scores       = ScoreLanes.ofDistance(judged.map(_._2)*)
  private val efforts      = Vector(DuelNumber.EvaderEffort, DuelNumber.PursuerEffort).map(asked)
  private val withVelocity = policies.exists(_.needsVelocity)

  /** How many numbers a world comes to. */
  val outcomes: Int = scores.initial.size + efforts.count(identity)

  /** What policies fly by, in tiles: of each its parameters, then what it remembers at first. */
  def numbersOf(self: Int, some: IndexedSeq[Policy]): Array[Float] =
    val count   = countOf(self)
    val numbers = Array.ofDim[Float]((some.size + Tile - 1) / Tile * Tile * count)
    for (policy, i) <- some.zipWithIndex do
      val own = policies(self).parametersOf(policy) ++ policies(self).initialOf(policy)
      for number <- own.indices do
        numbers((i / Tile * count + number) * Tile + i % Tile) = own(number).toFloat
    numbers

  private def countOf(self: Int) = policies(self).parameters + policies(self).memories

  private lazy val kernel: GpuKernel = gpu.kernel(text, Name)

  /** Flies worlds.
    *
    * @param blocks [[BlockWords]] numbers each: the address of its episode's operations, in two, how many,
    *   the first world, how many
    * @param stride words of an operation
    * @param numbers of evaders and of pursuers, see [[numbersOf]]
    * @param flownBy which of them candidates fly by
    * @param into what a number comes to in all worlds, number by number
    */
  def apply(
      count: Int,
      blocks: GpuBuffer,
      stride: Int,
      numbers: Vector[GpuBuffer],
      flownBy: Vector[GpuBuffer],
      captureRadiusM: Float,
      worlds: Int,
      into: GpuBuffer
  ): Unit =
    val read = Vector(blocks, stride, numbers(0), numbers(1), flownBy(0), flownBy(1))
    kernel(count, BlockWorlds, (read ++ Vector(captureRadiusM, worlds, into))*)

  /** What an episode's worlds came to.
    *
    * @param scoredAtS when the episode was scored
    */
  def outcome(number: DuelNumber, scoredAtS: Array[Float]): Outcome = number match
    case DuelNumber.EvaderEffort  => Outcome(scores.initial.size, OfMoment.Newest, 1)
    case DuelNumber.PursuerEffort => Outcome(outcomes - 1, OfMoment.Newest, 1)
    case _                        =>
      val place = judged.indexWhere(_._1 == number)
      val of    = scores.judged(place)
      Outcome(scores.places(place + 1) - 1, of.reduction, scoredAtS.count(of.counts(_)))

  /** The kernel. */
  lazy val text: String = Writer().module

  private final class Writer:
    private val code = Ptx(
      Name,
      Seq(
        "blocks"   -> Ptx.Kind.Address,
        "stride"   -> Ptx.Kind.Whole,
        "numbers0" -> Ptx.Kind.Address,
        "numbers1" -> Ptx.Kind.Address,
        "flownBy0" -> Ptx.Kind.Address,
        "flownBy1" -> Ptx.Kind.Address,
        "radius"   -> Ptx.Kind.Float,
        "worlds"   -> Ptx.Kind.Whole,
        "into"     -> Ptx.Kind.Address
      ),
      layout.bytes
    )
    private val end, loop, next = code.label()
    private val vehicles        = duelists.map(vehicle(code, _))
    private val kept            = Variables(code, scores.initial)
    private val effort          = Vector.fill(2)(Variables(code, Seq(0f)))
    private val heading         = duelists.map(each => Variables(code, Seq(each.startHeadingRad.toFloat)))
    private val memory          = policies.map(form => Variables(code, Seq.fill(form.memories)(0f)))

    def module: String =
      code.ownBase(): Unit
      val block = code.address(code.argument("blocks"), code.special("ctaid.x"), BlockWords)
      val own   = code.special("tid.x")
      code.goIf(code.compareWholes("ge", own, code.loadWhole(block, 4)), end)
      val world     = code.wholes("add.s32", code.loadWhole(block, 3), own)
      val candidate = code.wholes("add.s32", code.loadWhole(block, 5), own)
      val record    = code.loadAddress(block, 0)
      val left      = code.loadWhole(block, 2)
      val bytes     = code.wide(code.argument("stride"), 4)
      val numbers   = Vector.tabulate(2)(self => numbersAt(self, candidate))
      val loaded    = Vector.tabulate(2)(self => loadedAhead(self, numbers(self)))
      start(numbers)
      val radius   = code.argument("radius")
      val kind     = code.loadWhole(record)
      val nextKind = code.fresh()
      code.place(loop)
      code.goIf(code.compareWhole("le", left, 0), "stored")
      val following = code.sum(record, bytes)
      code.loadWhole(following, 0, nextKind): Unit
      val labels = Seq.fill(GpuTimetable.Labels)(code.label())
      code.goTo(kind, labels)
      val now = GpuRecord(code, record)
      for self <- 0 to 1 do
        part(labels(GpuTimetable.Look + self))(look(self, now, withVelocity = false))
        part(labels(GpuTimetable.LookAtAll + self))(look(self, now, withVelocity))
        part(labels(GpuTimetable.Act + self)):
          val at = now.place(1)
          vehicles(self).act(now, code.loadOwn(at, 0), code.loadOwn(at, 1))
        part(labels(GpuTimetable.Decide + self))(decide(self, now, loaded(self)))
      part(labels(GpuTimetable.Score))(score(now, radius))
      code.place(next)
      code(s"mov.b64 %rd$record, %rd$following")
      code(s"mov.b32 %r$kind, %r$nextKind")
      code(s"add.s32 %r$left, %r$left, -1")
      code.go(loop)
      code.place("stored")
      store(world)
      code.place(end)
      code("ret")
      code.module

    private def part(label: String)(body: => Unit): Unit =
      code.place(label)
      body
      code.go(next)

    /** The address of what this thread's policy flies by. */
    private def numbersAt(self: Int, candidate: Int): Int =
      val policy = code.loadWhole(code.address(code.argument(s"flownBy$self"), candidate))
      val tile   = code.wholes("shr.s32", policy, TileBits.toString)
      val within = code.wholes("and.b32", policy, (Tile - 1).toString)
      code.address(code.address(code.argument(s"numbers$self"), tile, countOf(self) * Tile), within)

    /** Few parameters stay in registers. */
    private def loadedAhead(self: Int, numbers: Int): Int => Int =
      val count = policies(self).parameters
      if count <= MostInRegisters then
        val registers = Vector.tabulate(count)(number => code.load(numbers, number * Tile))
        registers(_)
      else number => code.load(numbers, number * Tile)

    private def start(numbers: Vector[Int]): Unit =
      for self <- 0 to 1 do
        vehicles(self).start()
        effort(self).start()
        heading(self).start()
        for i <- 0 until policies(self).memories do
          code.load(numbers(self), (policies(self).parameters + i) * Tile, memory(self)(i)): Unit
        val at         = code.own(code.whole(layout.heading(self, 0)))
        val headingRad = duelists(self).startHeadingRad.toFloat.toDouble
        code.storeOwn(code.constant(StrictMath.cos(headingRad).toFloat), at, 0)
        code.storeOwn(code.constant(StrictMath.sin(headingRad).toFloat), at, 1)
      kept.start()

    private def look(self: Int, now: GpuRecord, withVelocity: Boolean): Unit =
      val seen = vehicles(self).look(now, withVelocity)
      val at   = now.place(1)
      for (value, i) <- seen.zipWithIndex do code.storeOwn(value, at, i)

    private def decide(self: Int, now: GpuRecord, parameter: Int => Int): Unit =
      import PolicyLanes.In
      val form                                        = policies(self)
      val Vector(own, opponent, known, before, after) =
        Vector.tabulate(5)(i => now.place(1 + i)): @unchecked
      val decided = PtxExpressions.write(code, form.nodes(efforts(self)))(
        {
          case read if read < LaneObservation.READ =>
            code.two("sub.rn", code.loadOwn(opponent, read), code.loadOwn(own, read))
          case In.Elapsed     => now.time(0)
          case In.OwnCos      => code.loadOwn(before, 0)
          case In.OwnSin      => code.loadOwn(before, 1)
          case In.KnownCos    => code.loadOwn(known, 0)
          case In.KnownSin    => code.loadOwn(known, 1)
          case In.Heading     => heading(self)(0)
          case In.OwnAge      => now.time(1)
          case In.OpponentAge => now.time(2)
          case remembered     => memory(self)(remembered - In.Memory)
        },
        parameter
      )
      code.storeOwn(decided(0), after, 0)
      code.storeOwn(decided(1), after, 1)
      if efforts(self) then effort(self).take(Seq(code.two("add.rn", effort(self)(0), decided(2))))
      val first = form.decided - (if efforts(self) then 0 else 1)
      memory(self).take(decided.slice(first, first + form.memories))
      if form.keepsHeading then heading(self).take(Seq(decided(first + form.memories)))

    private def score(now: GpuRecord, radius: Int): Unit =
      val seen = Vector.tabulate(2)(vehicle => now.place(1 + vehicle))
      val time = now.time(0)
      for stage <- scores.stages.reverse do
        val earlier = code.label()
        code.goIf(code.compare("lt", code.constant(stage.afterS), time), earlier, holds = false)
        add(stage, seen, time, radius)
        code.go(next)
        code.place(earlier)

    private def add(stage: ScoreLanes.Stage, seen: Vector[Int], time: Int, radius: Int): Unit =
      import ScoreLanes.Source
      val values = PtxExpressions.write(code, stage.function.nodes)(
        input =>
          scores.source(stage.function.inputs(input)) match
            case Source.Reading(vehicle, field) => code.loadOwn(seen(vehicle), field)
            case Source.Altitude(vehicle)       => code.constant(duelists(vehicle).altitudeDownM.toFloat)
            case Source.Kept(place)             => kept(place)
            case Source.Parameter(_, _)         => throw IllegalStateException("a distance has no parameters")
        ,
        number => if number == ScoreLanes.Time then time else radius
      )
      for (value, place) <- values.zip(stage.places) do code.move(value, kept(place))

    private def store(world: Int): Unit =
      val values = scores.initial.indices.map(kept(_)) ++ efforts.indices.filter(efforts).map(effort(_)(0))
      val worlds = code.argument("worlds")
      var at     = code.address(code.argument("into"), world)
      for value <- values do
        code.store(value, at)
        at = code.address(at, worlds)

private[lanes] object GpuDuelKernel:
  private val Name = "duels"

  /** A number that worlds of one episode come to.
    *
    * @param place of the number that is kept of it
    * @param count how often it counted
    */
  final class Outcome(val place: Int, reduction: Reduction | OfMoment, count: Int):
    def apply(kept: Float): Float = ScoreLanes.value(reduction, kept, count)

  /** How both decide. */
  final case class Forms(evader: PolicyLanes, pursuer: PolicyLanes)

  /** Worlds of a block: all of one episode. */
  val BlockWorlds: Int = 128

  /** Words that tell a block. */
  val BlockWords: Int = 6

  /** Policies whose numbers stand side by side, so that neighbours read neighbours. */
  private val Tile     = 32
  private val TileBits = 5

  /** More of a policy's parameters are read at each decision. */
  private val MostInRegisters = 16
