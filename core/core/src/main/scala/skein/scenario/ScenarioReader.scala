package skein.scenario

import scala.collection.mutable
import skein.formula.{Node, Untraceable}
import skein.policy.{GraphAction, PolicyGraph, PolicyInput}

/** Reads a [[ScenarioFile]], line by line. All sizes are limited, and no node depends on itself. */
private[scenario] final class ScenarioReader private (text: String):
  import ScenarioFile.*
  import ScenarioMistake.*
  import ScenarioNodes.Ahead
  import ScenarioReader.*

  private val nodes    = ScenarioNodes()
  private val settings = mutable.ArrayBuffer.empty[Setting]
  private val vehicles = mutable.ArrayBuffer.empty[VehicleLines]
  private val series   = mutable.ArrayBuffer.empty[SeriesLines]
  private val limits   = mutable.ArrayBuffer.empty[Bounded]
  private val once     = mutable.HashMap.empty[String, String]
  private var duration = Option.empty[Node]
  private var over     = Option.empty[(Int, Node)]

  /** Total number of nodes of all policies; a node that several vehicles use counts for each. */
  private var used = 0

  /** Number of the present line, for messages; 0 if there is none. */
  private var line = 0

  private def file(): ScenarioFile =
    if text.length > MostLetters then
      wrong(
        s"expected at most $MostLetters letters, got ${text.length}: too many vehicles, or too long policies"
      )
    val lines = text.linesIterator
    line = 1
    val head = ScenarioWords(if lines.hasNext then lines.next() else "", nodes)
    if !head.isNext(Head) then wrong(s"expected '$Head $Version', got another first line")
    val version = head.text("a version")
    if version != Version.toString then
      wrong(s"expected version $Version, got '${shown(version)}'; a newer Skein may read it")
    head.end()
    for each <- lines do
      line += 1
      if !each.isBlank && !each.startsWith("#") then
        val words = ScenarioWords(each, nodes)
        one(words)
        words.end()
    line = 0
    if vehicles.isEmpty then wrong("expected a vehicle, got none")
    val name = once.getOrElse("name", wrong("expected a line 'name', got none"))
    ScenarioFile(
      text,
      name,
      once.getOrElse("note", ""),
      once.getOrElse("scene", "empty"),
      settings.toVector,
      duration,
      vehicles.toVector.map(each => Vehicle(each.name, each.role, each.numbers, policy(each))),
      limits.toVector,
      series.toVector.map(drawn),
      over.map: (at, node) =>
        line = at
        watched(node, "over", PolicyInput.Elapsed, hasAges = true)
    )

  private def one(words: ScenarioWords): Unit =
    val first = words.name("a word")
    if first.head.isDigit then nodes.add(first, words, name => settings.indexWhere(_.name == name))
    else
      first match
        case "name" =>
          val name = words.key("a name")
          ScenarioNames.mistake(name).foreach(wrong(_))
          only("name", name)
        case "note"    => only("note", words.text("a text", MostNote))
        case "scene"   => only("scene", words.name("a scene"))
        case "setting" =>
          room(settings.size, MostSettings, "settings")
          val name = words.key("a setting's name")
          if settings.exists(_.name == name) then wrong(s"expected a setting's own name, got '$name' twice")
          settings += Setting(name, words.number("its default"), words.text("its meaning", MostNote))
        case "duration" =>
          if duration.isDefined then wrong("expected one line 'duration', got two")
          duration = Some(words.fixed())
        case "vehicle" =>
          room(vehicles.size, ScenarioNodes.MostVehicles, "vehicles")
          val (name, role) = (words.name("its name"), words.name("its role"))
          vehicles += VehicleLines(line, name, role, Vector.fill(5)(words.fixed()))
        case "does" =>
          val acts = vehicle("does").actions
          room(acts.size, MostActions, "actions of a vehicle")
          if acts.lastOption.exists(_._1.isEmpty) then
            wrong("expected no action after the one without a condition, got one that is never performed")
          acts += action(words)
        case "remembers" =>
          val memory = vehicle("remembers").memory
          room(memory.size, ScenarioNodes.MostMemory, "numbers of a memory")
          memory += ((words.fixed(), words.value()))
        case "wants" =>
          val wanting = vehicle("wants")
          if wanting.goal.nonEmpty then wrong("expected one line 'wants' of a vehicle, got two")
          wanting.goal = Vector(words.value(), words.value())
          wanting.limits = Vector(words.fixed(), words.fixed())
        case "limit"   => limit(words)
        case "series"  => quantity(words)
        case "measure" => measure(words)
        case "over"    =>
          if over.isDefined then wrong("expected one line 'over', got two")
          over = Some((line, words.condition()))
        case other =>
          wrong(s"expected a node's number or one of ${Words.mkString(", ")}, got '${shown(other)}'")

  private def only(key: String, value: String): Unit =
    if once.put(key, value).isDefined then wrong(s"expected one line '$key', got two")

  private def room(size: Int, most: Int, what: String): Unit =
    if size >= most then wrong(s"expected at most $most $what, got more")

  private def vehicle(word: String) =
    vehicles.lastOption.getOrElse(wrong(s"expected '$word' after a vehicle, got none"))

  private def action(words: ScenarioWords): (Option[Node], GraphAction[Node]) =
    val when    = Option.when(words.isNext("when"))(words.condition())
    val kind    = words.oneOf("an action", GraphAction.Kind.values)(_.word)
    val numbers = Vector.fill(kind.arity)(words.value())
    val yaw     =
      if kind.hasYaw && words.isNext("yaw") then words.oneOf("a yaw", GraphAction.YawKind.values)(_.word)
      else GraphAction.YawKind.Still
    (when, GraphAction(kind, numbers ++ Vector.fill(yaw.arity)(words.value()), yaw))

  private def limit(words: ScenarioWords): Unit =
    room(limits.size, MostLimits, "limits")
    val kind    = words.oneOf("a limit", LimitKind.values)(_.word)
    val numbers = if kind.count > 0 then Vector.fill(kind.count)(words.fixed()) else words.allFixed()
    if kind.count == 0 && (numbers.size < 6 || numbers.size % 2 != 0) then
      wrong(s"expected north and east of three corners or more, got ${numbers.size} numbers")
    limits += Bounded(kind, numbers)

  private def quantity(words: ScenarioWords): Unit =
    room(series.size, MostSeries, "series")
    val name = words.name("its name")
    if series.exists(_.name == name) then wrong(s"expected a series' own name, got '${shown(name)}' twice")
    val (unit, value) = (words.text("its unit"), words.value())
    val bound         = Option.when(words.isNext("bound"))((words.name("the bound's name"), words.fixed()))
    series += SeriesLines(line, name, unit, value, bound)

  private def measure(words: ScenarioWords): Unit =
    val of = series.lastOption.getOrElse(wrong("expected 'measure' after a series, got none"))
    room(series.iterator.map(_.measures.size).sum, MostMeasures, "measures")
    val name = words.name("its name")
    if series.exists(_.measures.exists(_.name == name)) then
      wrong(s"expected a measure's own name, got '${shown(name)}' twice")
    val reduction = words.oneOf("a reduction", Reduction.values)(kind => Scenario.worded(kind.toString))
    val window    =
      if reduction.mayBeNever then None
      else Seq("last", "after").find(words.isNext).map(word => word -> words.fixed())
    of.measures += Reduced(name, reduction, window)

  private def policy(of: VehicleLines): PolicyGraph =
    line = of.line
    if !of.actions.lastOption.exists(_._1.isEmpty) then
      wrong("expected a last action 'does' without a condition for this vehicle, got none")
    val (starts, next) = of.memory.toVector.unzip
    val decided        = of.actions.toVector.flatMap((when, act) => when ++ act.numbers) ++ next
    val read           = nodes.inputsOf(decided)
    val sought         = nodes.inputsOf(of.goal)
    read.foreach:
      case Ahead => wrong("expected 'ahead' in what a vehicle wants alone, got it in what it does")
      case PolicyInput.Memory(number) if number >= next.size =>
        wrong(s"expected a memory of ${number + 1} numbers, lines 'remembers', got ${next.size}")
      case other => exists(other)
    sought.foreach:
      case PolicyInput.Memory(_) => wrong("expected no memory in what a vehicle wants, got it")
      case other                 => exists(other)
    val inputs         = (read ++ sought).distinct.collect { case input: PolicyInput => input }
    val fixed          = starts ++ of.limits
    val (trace, graph) = nodes.moved(decided ++ of.goal ++ fixed, inputs :+ Ahead)
    val moved          = graph.iterator
    used += trace.size
    if used > MostUsed then wrong(s"expected at most $MostUsed nodes in what all vehicles do, got more")
    PolicyGraph(
      inputs,
      settings.map(_.name).toVector,
      of.actions.toVector.map: (when, act) =>
        val condition = when.map(_ => moved.next())
        (condition, act.copy(numbers = act.numbers.map(_ => moved.next())))
      ,
      next = next.map(_ => moved.next()),
      goal = of.goal.map(_ => moved.next()),
      starts = starts.map(_ => moved.next()),
      limits = of.limits.map(_ => moved.next())
    )

  private def exists(leaf: ScenarioNodes.Leaf): Unit =
    val vehicle = leaf match
      case PolicyInput.Position(vehicle, _) => vehicle
      case PolicyInput.Velocity(vehicle, _) => vehicle
      case PolicyInput.Heading(vehicle)     => vehicle
      case PolicyInput.Age(vehicle)         => vehicle
      case _                                => 0
    if vehicle >= vehicles.size then
      wrong(s"expected vehicles from 0 to ${vehicles.size - 1}, got a node of vehicle $vehicle")

  private def drawn(of: SeriesLines): Drawn =
    line = of.line
    val isOfPlaces = nodes.inputsOf(Seq(of.value)).forall:
      case _: PolicyInput.Position | PolicyInput.Elapsed => true
      case _                                             => false
    val seen  = watched(of.value, "series", PolicyInput.Elapsed, hasAges = false)
    val graph = Option.when(isOfPlaces):
      val places = for axis <- 0 to 2; vehicle <- vehicles.indices yield PolicyInput.Position(vehicle, axis)
      val (trace, numbers) = nodes.moved(Vector(of.value), places.toVector :+ PolicyInput.Elapsed)
      QuantityGraph(trace, numbers.head, vehicles.size, settings.map(_.name).toVector)
    Drawn(of.name, of.unit, seen, graph, of.bound, of.measures.toVector)

  private def watched(node: Node, what: String, time: PolicyInput, hasAges: Boolean): Watched =
    val read = nodes.inputsOf(Seq(node)).map:
      case input: (PolicyInput.Position | PolicyInput.Velocity) => input
      case input: PolicyInput.Age if hasAges                    => input
      case input: PolicyInput if input == time                  => input
      case _                                                    =>
        val ages = if hasAges then "positions, velocities, ages" else "positions, velocities"
        wrong(s"expected $what of $ages and elapsed alone, got a node of something else")
    read.foreach(exists)
    val (trace, moved) = nodes.moved(Vector(node), read)
    Watched(trace, moved.head, read)

private[scenario] object ScenarioReader:
  private final class VehicleLines(
      val line: Int,
      val name: String,
      val role: String,
      val numbers: Vector[Node]
  ):
    val actions: mutable.ArrayBuffer[(Option[Node], GraphAction[Node])] = mutable.ArrayBuffer.empty
    val memory: mutable.ArrayBuffer[(Node, Node)]                       = mutable.ArrayBuffer.empty

    /** The wanted position of a goal; and its maximum speed and minimum separation. */
    var goal, limits: Vector[Node] = Vector.empty

  private final class SeriesLines(
      val line: Int,
      val name: String,
      val unit: String,
      val value: Node,
      val bound: Option[(String, Node)]
  ):
    val measures: mutable.ArrayBuffer[ScenarioFile.Reduced] = mutable.ArrayBuffer.empty

  private val MostLetters  = 4 << 20
  private val MostUsed     = 200_000
  private val MostNote     = 1000
  private val MostSettings = 200
  private val MostActions  = 32
  private val MostLimits   = 100
  private val MostSeries   = 100
  private val MostMeasures = 200

  private val Words = Vector(
    "name",
    "note",
    "scene",
    "setting",
    "duration",
    "vehicle",
    "does",
    "remembers",
    "wants",
    "limit",
    "series",
    "measure",
    "over"
  )

  /** Reads a file.
    *
    * @return Left describes the first mistake in one line
    */
  def read(text: String): Either[String, ScenarioFile] =
    val reader = ScenarioReader(text)
    try Right(reader.file())
    catch
      case mistake: ScenarioMistake =>
        Left(if reader.line == 0 then mistake.getMessage else s"line ${reader.line}: ${mistake.getMessage}")
      case tooMuch: Untraceable => Left(s"line ${reader.line}: ${tooMuch.getMessage}")
