package skein.settings

import java.io.RandomAccessFile
import java.nio.file.{Files, Path}
import skein.testing.TemporaryFolders

class TextFileSuite extends munit.FunSuite, TemporaryFolders:

  test("a file that is too large is refused, not read"):
    val file = temporaryFolder().resolve("large.conf")
    val size = RandomAccessFile(file.toFile, "rw")
    try size.setLength(3L << 30)
    finally size.close()
    try
      assert(clue(TextFile.read(file.toString)).left.exists(_.contains("expected a file of at most 64 MiB")))
    finally Files.delete(file)

  test("a text is read whole; other bytes, folders and missing files are reported"):
    val folder = temporaryFolder()
    val file   = Files.writeString(folder.resolve("a.conf"), "zwei = \u0662")
    assertEquals(TextFile.read(file.toString), Right("zwei = \u0662"))
    Files.writeString(file, "\ufeffzwei = 2"): Unit
    assertEquals(TextFile.read(file.toString), Right("zwei = 2"))
    Files.write(file, Array[Byte](-1, -2))
    assert(TextFile.read(file.toString).left.exists(_.contains("no text in UTF-8")))
    assert(TextFile.read(folder.toString).left.exists(_.contains("got the folder")))
    assertEquals(TextFile.read(s"$file-not"), Left(s"there is no file $file-not"))
    val here = Path.of("").toAbsolutePath
    assertEquals(TextFile.read("no/such.conf"), Left(s"there is no file no/such.conf, sought from $here"))
