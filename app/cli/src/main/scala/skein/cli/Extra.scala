package skein.cli

import java.nio.file.Path
import scala.util.Try
import skein.units.Expect

/** A library that the packaged program does without until its archive of extras is unpacked over it.
  *
  * @param library words for the user
  * @param known a class of the library
  */
private[cli] enum Extra(library: String, known: String):
  case Kafka    extends Extra("Kafka's client", "org.apache.kafka.clients.producer.KafkaProducer")
  case Postgres extends Extra("Postgres' driver", "org.postgresql.Driver")

  /** @return Left says where the library is expected */
  def checked: Either[String, Unit] =
    Expect.that(Try(Class.forName(known, false, getClass.getClassLoader)).isSuccess):
      s"expected $library in ${Extra.folder}, got none; unpack skein-…-extras.tar.gz over the program"

private object Extra:
  private def folder: Path =
    Path.of(classOf[Extra].getProtectionDomain.getCodeSource.getLocation.toURI).resolveSibling("extra")
