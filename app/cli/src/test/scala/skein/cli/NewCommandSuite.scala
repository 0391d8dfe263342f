package skein.cli

import java.nio.file.StandardOpenOption.APPEND
import java.nio.file.attribute.FileTime
import java.nio.file.{Files, Path}
import java.time.Instant
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.testing.TemporaryFolders

class NewCommandSuite extends munit.FunSuite, TemporaryFolders:

  private def run(words: String*): (Int, String) =
    val ran = Ran.of(NewCommand.run(words))
    (ran.status, ran.said)

  folder.test("a project is written completely, with its name, and without placeholders"): folder =>
    val project = folder.resolve("somewhere")
    assertEquals(run("ridge-watch", "--out", project.toString)._1, 0)
    val files =
      Using.resource(Files.walk(project))(_.iterator.asScala.filter(Files.isRegularFile(_)).toVector)
    val paths = files.map(project.relativize(_).toString).toSet
    assertEquals(paths & NewCommandSuite.Expected, NewCommandSuite.Expected)
    for file <- files do
      val text = Files.readString(file)
      assert(!"@[A-Z]+@".r.unanchored.matches(text), s"$file:\n$text")
    assert(Files.isExecutable(project.resolve("skein")))
    assert(Files.readString(project.resolve("build.sbt")).contains("ridge-watch"))

  test("a name of a flight's setting is refused, since the scenario could not be flown"):
    val (status, said) = run("seed")
    assertEquals(status, 1)
    assert(clue(said).contains("that is no setting of flights, got 'seed'; for example seed-flight"))

  folder.test("the printed commands can be typed into a shell, whatever the folder's name"): folder =>
    for (name, typed) <- Seq("ridge" -> s"$folder/ridge", "my 'own' ü" -> s"'$folder/my '\\''own'\\'' ü'") do
      val (status, told) = run("ridge-watch", "--out", s"$folder/$name")
      assertEquals(status, 0, told)
      assert(clue(told).contains(s"fly it: cd $typed && ./skein"))

  folder.test(
    "a project is built again only after a change, after a move, and for other libraries"
  ): folder =>
    val (first, moved) = (folder.resolve("ridge"), folder.resolve("moved here"))
    assertEquals(run("ridge-watch", "--out", first.toString)._1, 0)
    // Replaces sbt: counts calls, and names a library that no JVM loads, so that nothing runs.
    val agent = Files.createFile(folder.resolve("agent.jar"))
    val _     = Files.writeString(
      first.resolve("sbtw"),
      s"""#!/bin/sh
         |echo built >>target/builds
         |printf '"-javaagent:$agent"' >target/launch
         |""".stripMargin
    )
    def builds(project: Path, through: Option[Path] = None): Int =
      val log     = folder.resolve("log").toFile
      val started = through.getOrElse(project.resolve("skein"))
      val _ = ProcessBuilder(started.toString).redirectErrorStream(true).redirectOutput(log).start().waitFor()
      Files.readAllLines(project.resolve("target/builds")).size
    def age(file: Path): Unit =
      val _ = Files.setLastModifiedTime(file, FileTime.from(Instant.now.minusSeconds(60)))
    def save(file: Path): Unit =
      age(moved.resolve("target/launch"))
      val _ = Files.writeString(file, "\n", APPEND)
    assertEquals(builds(first), 1)
    assertEquals(builds(first), 1)
    val _ = Files.move(first, moved)
    assertEquals(builds(moved), 2)
    assertEquals(builds(moved), 2)
    // It is also found through symbolic links.
    val links = Files.createDirectories(folder.resolve("links"))
    Files.createSymbolicLink(links.resolve("one"), Path.of("../moved here/skein"))
    Files.createSymbolicLink(links.resolve("two"), links.resolve("one"))
    age(moved.resolve("target/launch"))
    save(moved.resolve("src/main/scala/ridgewatch/RidgeWatch.scala"))
    assertEquals(builds(moved, Some(links.resolve("two"))), 3)
    save(agent)
    // An installed library keeps the time at which it was built.
    age(agent)
    assertEquals(builds(moved), 4)

  folder.test("a folder's path may lead through a folder that does not exist yet"): folder =>
    val (status, told) = run("ridge-watch", "--out", s"$folder/missing/../x")
    assertEquals(status, 0, told)
    assert(Files.exists(folder.resolve("x/build.sbt")))

  folder.test("an existing folder is left unchanged"): folder =>
    val (status, told) = run("ridge-watch", "--out", folder.toString)
    assertNotEquals(status, 0)
    assert(told.contains("expected a folder that is not there yet"), told)

  folder.test("a folder that cannot be created is reported, and no part of it remains"): folder =>
    val file           = Files.createFile(folder.resolve("file"))
    val (status, told) = run("ridge-watch", "--out", s"$file/in/it")
    assertEquals(
      (status, told),
      (1, s"skein new: --out: cannot write into the folder $file/in/it: Not a directory ($file/in)\n")
    )
    // Its name is short enough for a folder, and its files' paths are too long.
    val deep         = s"$folder/" + (1 to 19).map(_ => "d" * 210).mkString("/")
    val (again, why) = run("ridge-watch", "--out", deep)
    assertEquals(again, 1)
    assert(clue(why).startsWith("skein new: "))
    assertEquals(folder.toFile.list.toSeq, Seq("file"))

  test("a name that would not compile is refused, and a valid one is proposed"):
    for name <- Seq("object", "scenario", "agent", "scala", "skein", "vector3", "corners", "main", "type") do
      val (status, told) = run(name)
      assertNotEquals(status, 0, name)
      assert(told.contains(s"$name-flight"), told)
    for name <- Seq("leader-flight", "leader", "patrol") do
      assertEquals(run(name, "--out", "/")._2.contains("-flight"), false, name)

  test("an invalid project name is refused"):
    for name <- Seq("Ridge", "../ridge", "ridge watch", "-", "") do
      val (status, told) = run(name)
      assertNotEquals(status, 0, name)
      assert(told.contains("expected") && !Files.exists(Path.of("ridge")), told)

object NewCommandSuite:
  private val Expected = Set(
    "build.sbt",
    "skein",
    "sbtw",
    "README.md",
    "src/main/scala/ridgewatch/RidgeWatch.scala",
    "src/test/scala/ridgewatch/RidgeWatchSuite.scala"
  )
