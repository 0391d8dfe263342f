package skein.cluster

import java.nio.file.{Files, Path}
import java.util.zip.{ZipEntry, ZipOutputStream}
import scala.util.Using
import skein.testing.TemporaryFolders

class BuildIdSuite extends munit.FunSuite, TemporaryFolders:
  private val classes =
    Vector("skein/a/One.class" -> "one", "skein/a/b/Two.class" -> "two", "Three.class" -> "3")

  private def inFolder(files: Seq[(String, String)]): Path =
    val folder = temporaryFolder()
    for (name, text) <- files do
      val file = folder.resolve(name)
      Files.createDirectories(file.getParent)
      Files.writeString(file, text): Unit
    folder

  private def inJar(files: Seq[(String, String)]): Path =
    val jar = temporaryFolder().resolve("classes.jar")
    Using.resource(ZipOutputStream(Files.newOutputStream(jar))): out =>
      for (name, text) <- files do
        out.putNextEntry(ZipEntry(name))
        out.write(text.getBytes)
    jar

  test("equal classes have one build id, in a folder, in a jar, or in several of them in any order"):
    val build = BuildId.of(Vector(inFolder(classes)))
    assert(build.matches("[0-9a-f]{16}"), build)
    assertEquals(BuildId.of(Vector(inJar(classes))), build)
    assertEquals(BuildId.of(Vector(inFolder(classes.drop(1)), inJar(classes.take(2)))), build)
    assertEquals(BuildId.of(Vector(inFolder(classes), Path.of("no", "such", "folder"))), build)

  test("a changed, additional or moved class changes the build id, and other files do not"):
    val build = BuildId.of(Vector(inFolder(classes)))
    for
      files <- Seq(
        classes.updated(0, "skein/a/One.class" -> "eins"),
        classes :+ "Four.class" -> "4",
        classes.drop(1),
        classes.updated(0, "skein/b/One.class" -> "one")
      )
      path <- Seq(inFolder(files), inJar(files))
    do assertNotEquals(BuildId.of(Vector(path)), build)
    for path <- Seq(inFolder(classes :+ "note.txt" -> "x"), inJar(classes :+ "class" -> "x")) do
      assertEquals(BuildId.of(Vector(path)), build)
