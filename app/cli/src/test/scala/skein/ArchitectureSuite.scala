package skein

import java.nio.file.{Files, Path}

/** Compares the sources with ARCHITECTURE.md: modules, packages, and that imports point downwards. */
class ArchitectureSuite extends munit.FunSuite:
  private val root =
    Iterator.iterate(Path.of("").toAbsolutePath)(_.getParent).find(at =>
      Files.exists(at.resolve("ARCHITECTURE.md"))
    ).get

  private val house = House.under(root)

  private val row = """\| (?:`([\w-]+)`)? ?\| `(skein[\w.]*)` \|.*""".r

  /** Module and package of each row of the page's table, from the top down. */
  private val rooms: Vector[(String, String)] =
    Files
      .readString(root.resolve("ARCHITECTURE.md"))
      .linesIterator
      .collect { case row(module, room) => (Option(module), room) }
      .scanLeft(("", "")) { case ((before, _), (module, room)) => (module.getOrElse(before), room) }
      .drop(1)
      .toVector

  private val floor: Map[String, Int] = rooms.map(_._2).zipWithIndex.toMap.withDefaultValue(-1)

  test("every package is in the page's table, under its module, and every row has sources"):
    val there = house.sources.map(source => (source.module, source.room)).toSet
    assertEquals(there -- rooms, Set.empty)
    assertEquals(rooms.toSet -- there, Set.empty)

  /** By room: the modules of its table, and the rooms that its line lets it import. */
  private val tables: Map[String, (Set[String], String)] =
    """(?s)### `(\w+)`\n\n[^\n]*May import: ([^\n]*)\n(.*?)(?=\n#|\n`docs`)""".r
      .findAllMatchIn(Files.readString(root.resolve("ARCHITECTURE.md")))
      .map: found =>
        val modules = found.group(3).linesIterator.collect { case row(module, _) if module != null => module }
        found.group(1) -> (modules.toSet, found.group(2))
      .toMap

  test("every module is in the folder of its room"):
    val there = house.sources.map(source => (house.room(root, source), source.module)).toSet
    val told  = for (room, (modules, _)) <- tables.toSet; module <- modules yield (room, module)
    assertEquals(there -- told, Set.empty)
    assertEquals(told -- there, Set.empty)

  test("a room imports only the rooms in its line of the page"):
    val found =
      for
        (source, used) <- house.uses.toVector
        other          <- used
        (from, to) = (house.room(root, source), house.room(root, other)) if from != to
        may        = tables(from)._2 if !may.startsWith("everything") && !may.contains(s"`$to`")
      yield s"$from imports $to: $source uses $other"
    assertEquals(found.sorted, Vector.empty)

  test("packages import only from packages below them"):
    val upwards =
      for
        (source, used) <- house.uses.toVector
        other          <- used if floor(other.room) < floor(source.room)
      yield s"$source uses $other"
    assertEquals(upwards.sorted, Vector.empty)

  test("no source files form a cycle of uses"):
    val circles = house.circles.map: circle =>
      circle
        .map(source => s"$source uses ${house.uses(source).filter(circle.contains).mkString(", ")}")
        .mkString("\n")
    assert(circles.isEmpty, circles.mkString("\n\n"))

  test("the core and forward simulation import no streams, files, sockets or clocks"):
    val forbidden =
      Vector(
        "org.apache.pekko",
        "java.nio.file",
        "java.nio.channels",
        "java.io",
        "java.net",
        "java.lang.foreign",
        "nanoTime",
        "currentTimeMillis"
      )
    val found =
      for
        source <- house.sources if source.module == "core" || source.module == "forward"
        if !source.path.endsWith("units/Clock.scala")
        word <- forbidden if source.says(word)
      yield s"$source says $word"
    assertEquals(found, Vector.empty)

  test("the loops import no simulator, no wire protocol and no AirSim"):
    val found =
      for
        source <- house.sources if source.room.startsWith("skein.loop")
        other  <- house.uses(source) if Set("airsim", "simulator", "link").contains(other.module)
      yield s"$source uses $other"
    assertEquals(found, Vector.empty)
