package skein

import java.nio.file.{Files, Path}

/** Holds the sources to ARCHITECTURE.md: what stands where, and that imports point downwards. */
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

  test("every package stands in the page's table, in its module, and every row has sources"):
    val there = house.sources.map(source => (source.module.replace('/', '-'), source.room)).toSet
    assertEquals(there -- rooms, Set.empty)
    assertEquals(rooms.toSet -- there, Set.empty)

  test("packages import only what stands below them"):
    val upwards =
      for
        (source, used) <- house.uses.toVector
        other          <- used if floor(other.room) < floor(source.room)
      yield s"$source uses $other"
    assertEquals(upwards.sorted, Vector.empty)

  test("no file uses itself by way of others"):
    val circles = house.circles.map: circle =>
      circle
        .map(source => s"$source uses ${house.uses(source).filter(circle.contains).mkString(", ")}")
        .mkString("\n")
    assert(circles.isEmpty, circles.mkString("\n\n"))

  test(
    "the core and forward simulation know no streams, no files, no sockets and no clock of their own, but for the GPU's driver"
  ):
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
    val drivers = Set("Cuda.scala", "CudaGpu.scala").map("skein/gpu/" + _)
    val found   =
      for
        source <- house.sources if source.module == "core" || source.module == "forward"
        if !source.path.endsWith("units/Clock.scala") && !drivers.exists(source.path.endsWith)
        word <- forbidden if source.says(word)
      yield s"$source says $word"
    assertEquals(found, Vector.empty)

  test("the loops know no simulator, no wire and no AirSim"):
    val found =
      for
        source <- house.sources if source.room.startsWith("skein.loop")
        other  <- house.uses(source) if Set("airsim", "simulator", "link").contains(other.module)
      yield s"$source uses $other"
    assertEquals(found, Vector.empty)
