package skein.cluster.jars

import java.io.{File, OutputStream}
import java.nio.file.{Files, Path}
import java.time.LocalDateTime
import java.util.zip.{CRC32, ZipEntry, ZipOutputStream}
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** What this process runs by. */
object ClassPath:

  /** Jars and folders that are there, in their order. */
  def current: Vector[Path] =
    sys.props("java.class.path")
      .split(File.pathSeparatorChar)
      .toVector
      .filter(_.nonEmpty)
      .map(Path.of(_))
      .filter(Files.exists(_))

  /** A part as a jar; a folder is named by the jar that it would be. */
  private[jars] def jar(part: Path): Jar =
    val (sha256, bytes) = Sha256.written(write(part, _))
    Jar(sha256, bytes)

  /** A jar as it is. A folder as a jar with the same bytes on every machine: names in their order, neither
    * compressed nor dated.
    */
  private[jars] def write(part: Path, to: OutputStream): Unit =
    if !Files.isDirectory(part) then Files.copy(part, to): Unit
    else
      val files = Using
        .resource(Files.walk(part))(_.iterator.asScala.filter(Files.isRegularFile(_)).toVector)
        .map(file => part.relativize(file).toString.replace(File.separatorChar, '/') -> file)
      val out = ZipOutputStream(to)
      for (name, file) <- files.sortBy(_._1) do
        val bytes = Files.readAllBytes(file)
        val crc   = CRC32()
        crc.update(bytes)
        val entry = ZipEntry(name)
        entry.setMethod(ZipEntry.STORED)
        entry.setSize(bytes.length)
        entry.setCrc(crc.getValue)
        entry.setTimeLocal(Undated)
        out.putNextEntry(entry)
        out.write(bytes)
        out.closeEntry()
      out.finish()

  private val Undated = LocalDateTime.of(1980, 1, 1, 0, 0)
