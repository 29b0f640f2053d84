//! Falls beside those of two half-spaces in perfect contact.

use contact_model::material::SKIN;
use contact_model::reference::interface_temperature;
use experiment_statistics::correlation::pearson;

use super::falls::{all, levels};
use crate::cells::mean;
use crate::input::{Task, finite};
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// Correlation of the mean falls of the materials with the model's.
pub fn pearson_with_model(task: &Task) -> Section {
    let mut section = Section::new("pearson-with-model", "Falls and model").note(
        "The model is Eq. 3-1 of the thesis: two half-spaces in perfect contact, with the measured mean temperatures of skin and \
         room. A thermistor at the edge of the contact sees only a part of that fall, so the correlation counts, and not the \
         size. n counts materials.",
    );
    let falls = all(task);
    let (parts, materials) = levels(task, &falls);
    let mut table = Table::new(
        "falls-model",
        "Mean falls and those of Eq. 3-1",
        [
            words("part"),
            words("material"),
            numbers("measured", "K", 3),
            numbers("model", "K", 3),
            numbers("measured over model", "", 3),
        ],
    );
    let mut correlations = Table::new(
        "pearson-with-model",
        "Correlation over the materials",
        [words("part"), words("n"), numbers("r", "", 3), probabilities("p")],
    );
    for part in &parts {
        let mut pairs = Vec::new();
        for material in &materials {
            let of = || {
                falls
                    .iter()
                    .filter(|fall| fall.group.part == *part && fall.group.material == *material)
            };
            let measured_k = mean(of().map(|fall| fall.fall_k));
            let skin_c = mean(of().filter_map(|fall| fall.skin_c));
            let room_c = mean(of().filter_map(|fall| fall.room_c));
            let model = |skin_c: f64, room_c: f64| {
                let object = task.materials.get(material)?;
                finite(skin_c - interface_temperature(&SKIN, skin_c, object, room_c))
            };
            let model_k = skin_c.zip(room_c).and_then(|(skin_c, room_c)| model(skin_c, room_c));
            if let Some((measured_k, model_k)) = measured_k.zip(model_k) {
                table.row(cells![
                    part.clone(),
                    material.clone(),
                    measured_k,
                    model_k,
                    measured_k / model_k
                ]);
                pairs.push((measured_k, model_k));
            }
        }
        let (measured, model): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        match pearson(&measured, &model) {
            Ok(found) => correlations.row(cells![part.clone(), found.pairs, found.r, found.p]),
            Err(error) => section.lacks(part, error),
        }
    }
    if parts.is_empty() {
        section.lacks("Correlation", "no contact that counts has a fall of the skin");
    }
    section.add(correlations);
    section.add(table);
    section
}
